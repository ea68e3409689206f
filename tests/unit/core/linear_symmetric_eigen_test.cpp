#include "core/linear/symmetric_eigen.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

namespace core {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd rotation(Index n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian;
  const MatrixXd noise = MatrixXd::NullaryExpr(n, n, [&] { return gaussian(random); });
  return Eigen::HouseholderQR<MatrixXd>(noise).householderQ();
}

MatrixXd with_values(const VectorXd& values, unsigned seed) {
  const MatrixXd q = rotation(values.size(), seed);
  const MatrixXd a = q * values.asDiagonal() * q.transpose();
  return 0.5 * (a + a.transpose());
}

void expect_eigenpairs(const MatrixXd& a, Index count) {
  const SymmetricEigen eigen(a);
  const MatrixXd v = eigen.leading_vectors(count);
  const double size = eigen.values().cwiseAbs().maxCoeff() + 1e-300;
  const VectorXd expected = Eigen::SelfAdjointEigenSolver<MatrixXd>(a).eigenvalues().reverse();
  EXPECT_LT((eigen.values() - expected).cwiseAbs().maxCoeff(), 1e-13 * size * static_cast<double>(a.rows()));
  EXPECT_LT((a * v - v * eigen.values().head(count).asDiagonal()).norm(), 1e-11 * size);
  EXPECT_LT((v.transpose() * v - MatrixXd::Identity(count, count)).norm(), 1e-7);
}

TEST(SymmetricEigen, FindsValuesAndLeadingVectors) {
  for (const Index n : {1, 2, 3, 4, 7, 40, 131}) {
    VectorXd values(n);
    for (Index k = 0; k < n; ++k) values[k] = std::pow(0.93, static_cast<double>(k)) - (k % 3 == 2 ? 0.5 : 0.0);
    expect_eigenpairs(with_values(values, static_cast<unsigned>(n)), (n + 1) / 2);
  }
}

TEST(SymmetricEigen, EqualValuesGiveOrthogonalVectors) {
  VectorXd values = VectorXd::Zero(30);
  values.head(6).setConstant(4.0);
  values.segment(6, 5).setConstant(1.0);
  expect_eigenpairs(with_values(values, 7), 11);
  expect_eigenpairs(MatrixXd::Identity(12, 12), 5);
}

TEST(SymmetricEigen, DiagonalAndBlockMatricesAreNoTrouble) {
  expect_eigenpairs(VectorXd::LinSpaced(9, -3.0, 5.0).asDiagonal(), 9);
  MatrixXd blocks = MatrixXd::Zero(20, 20);
  blocks.topLeftCorner(10, 10) = with_values(VectorXd::LinSpaced(10, 1.0, 2.0), 3);
  blocks.bottomRightCorner(10, 10) = blocks.topLeftCorner(10, 10);  // every value twice
  expect_eigenpairs(blocks, 8);
  expect_eigenpairs(MatrixXd::Zero(6, 6), 3);
}

}  // namespace
}  // namespace core
