#include "core/linear/dense.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/noise_matrix.h"

namespace core {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using test_support::noise_matrix;

TEST(Dense, ProductsAddToWhatIsThere) {
  for (const Index n : {1, 2, 3, 31, 97, 130}) {
    const MatrixXd a = noise_matrix(n, n + 5, 1), b = noise_matrix(n + 5, 7, 2), before = noise_matrix(n, 7, 3);
    MatrixXd c = before;
    add_product(c, -2.0, a, b);
    EXPECT_LT((c - (before - 2.0 * a * b)).cwiseAbs().maxCoeff(), 1e-12 * static_cast<double>(n + 10)) << n;
    add_product_transposed(c, 2.0, a, b.transpose());
    EXPECT_LT((c - before).cwiseAbs().maxCoeff(), 1e-12 * static_cast<double>(n + 10)) << n;
  }
}

TEST(Dense, ProductsOfBlocksLeaveTheRestAlone) {
  MatrixXd c = MatrixXd::Constant(9, 9, 5.0);
  const MatrixXd a = noise_matrix(4, 3, 1), b = noise_matrix(3, 5, 2);
  add_product(c.block(2, 1, 4, 5), 1.0, a, b);
  MatrixXd expected = MatrixXd::Constant(9, 9, 5.0);
  expected.block(2, 1, 4, 5) += a * b;
  EXPECT_LT((c - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Dense, GramIsTheProductWithItself) {
  for (const Index n : {1, 5, 24, 25, 70}) {
    const MatrixXd a = noise_matrix(n, 40, 6), product = gram(a);
    EXPECT_LT((product - a * a.transpose()).cwiseAbs().maxCoeff(), 1e-12) << n;
    EXPECT_EQ((product - product.transpose()).norm(), 0.0) << n;
  }
}

TEST(Dense, FactorsAndDividesTheRowsBelow) {
  for (const Index n : {1, 5, 8, 9, 70}) {
    const MatrixXd root = noise_matrix(n, n + 3, 4), below = noise_matrix(6, n, 5);
    const MatrixXd covariance = root * root.transpose();
    MatrixXd m(n + 6, n);
    m << covariance, below;
    m.topRows(n).triangularView<Eigen::StrictlyUpper>().setConstant(1e300);  // is not read
    ASSERT_TRUE(factor_stacked(m)) << n;
    const MatrixXd lower = m.topRows(n);
    EXPECT_LT((lower * lower.transpose() - covariance).norm(), 1e-13 * covariance.norm()) << n;
    EXPECT_EQ(MatrixXd(lower.triangularView<Eigen::StrictlyUpper>()).norm(), 0.0);
    EXPECT_LT((m.bottomRows(6) * lower.transpose() - below).norm(), 1e-10 * below.norm()) << n;

    MatrixXd x = below;
    divide_by_lower(x, lower);
    EXPECT_LT((x * lower - below).norm(), 1e-10 * below.norm()) << n;
  }
}

TEST(Dense, RefusesWhatIsNotPositiveDefinite) {
  MatrixXd indefinite = MatrixXd::Identity(20, 20);
  indefinite(13, 13) = -1.0;
  EXPECT_FALSE(factor_stacked(indefinite));
  MatrixXd not_finite = MatrixXd::Identity(20, 20);
  not_finite(11, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(factor_stacked(not_finite));
}

}  // namespace
}  // namespace core
