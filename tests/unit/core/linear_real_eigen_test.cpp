#include "core/linear/real_eigen.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "core/identification/mac.h"
#include "tests/support/noise_matrix.h"

namespace core {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using test_support::noise_matrix;

std::vector<Complex> column(const Eigen::MatrixXcd& m, Index k) { return {m.col(k).begin(), m.col(k).end()}; }

// Every value in the upper half plane, once, with the shape that Eigen's solver gives.
void expect_as_eigen(const MatrixXd& a, const MatrixXd& c) {
  UpperEigen found;
  ASSERT_TRUE(upper_half_plane_eigen(a, c, found));
  const Eigen::EigenSolver<MatrixXd> expected(a);
  const Eigen::MatrixXcd seen = c * expected.eigenvectors();
  std::size_t n_upper = 0;
  for (Index k = 0; k < a.rows(); ++k) {
    const Complex value = expected.eigenvalues()[k];
    if (!(value.imag() > 0.0)) continue;
    ++n_upper;
    const auto nearest = std::min_element(found.values.begin(), found.values.end(), [&](Complex x, Complex y) {
      return std::abs(x - value) < std::abs(y - value);
    });
    ASSERT_NE(nearest, found.values.end());
    EXPECT_LT(std::abs(*nearest - value), 1e-11 * a.norm());
    const Index at = nearest - found.values.begin();
    EXPECT_GT(mac(column(found.seen, at), column(seen, k)), 1.0 - 1e-9);
    EXPECT_NEAR(found.seen.col(at).norm(), seen.col(k).norm(), 1e-6 * c.norm());
  }
  EXPECT_EQ(found.values.size(), n_upper);
}

TEST(RealEigen, FindsWhatEigenFinds) {
  for (const Index n : {1, 2, 3, 4, 5, 12, 37, 60}) {
    for (unsigned seed = 1; seed <= 5; ++seed)
      expect_as_eigen(noise_matrix(n, n, seed), noise_matrix(4, n, seed + 100));
  }
}

TEST(RealEigen, MatricesThatFallApart) {
  MatrixXd blocks = MatrixXd::Zero(6, 6);
  for (Index k = 0; k < 3; ++k) {
    const double angle = 0.3 + 0.4 * static_cast<double>(k);
    blocks.block(2 * k, 2 * k, 2, 2) << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  }
  expect_as_eigen(blocks, noise_matrix(3, 6, 1));
  expect_as_eigen(MatrixXd::Zero(5, 5), noise_matrix(3, 5, 1));
  MatrixXd cyclic = MatrixXd::Zero(8, 8);  // plain QR does not converge on it
  for (Index k = 0; k < 8; ++k) cyclic((k + 1) % 8, k) = 1.0;
  expect_as_eigen(cyclic, noise_matrix(3, 8, 2));
}

}  // namespace
}  // namespace core
