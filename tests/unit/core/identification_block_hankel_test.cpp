#include "core/identification/block_hankel.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "tests/support/random_system.h"

namespace core {
namespace {

// R_ij(lag) = 100 i + 10 j + lag / 8 for any order of i and j; undivided: its negative.
Correlations numbered() {
  Correlations correlations(3, 12);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      for (int lag = -12; lag <= 12; ++lag)
        correlations.set(i, j, lag, 100.0 * i + 10.0 * j + lag / 8.0, -(100.0 * i + 10.0 * j + lag / 8.0));
    }
  }
  return correlations;
}

double expected(int i, int j, int lag) {
  return i <= j ? 100.0 * i + 10.0 * j + lag / 8.0 : 100.0 * j + 10.0 * i - lag / 8.0;
}

TEST(BlockHankel, HoldsLagsFromTheFirstOnOutputsByReferences) {
  const std::vector<int> references{2, 0};
  const Eigen::Vector3d scale(1.0, 2.0, 5.0);
  const Eigen::MatrixXd h = block_hankel(numbered(), references, scale, 4, 3, 2);
  ASSERT_EQ(h.rows(), 12);
  ASSERT_EQ(h.cols(), 6);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 3; ++b) {
      for (int y = 0; y < 3; ++y) {
        for (int r = 0; r < 2; ++r) {
          const int reference = references[static_cast<std::size_t>(r)];
          EXPECT_DOUBLE_EQ(h(a * 3 + y, b * 2 + r), expected(y, reference, 2 + a + b) / (scale[y] * scale[reference]));
        }
      }
    }
  }
}

TEST(BlockToeplitz, HoldsTheUndividedLagsInFutureAndPastOrder) {
  const std::vector<int> channels{1, 2};
  const Eigen::Vector3d scale(1.0, 2.0, 5.0);
  for (const bool past : {false, true}) {
    const Eigen::MatrixXd t = block_toeplitz(numbered(), channels, scale, 3, past);
    ASSERT_EQ(t.rows(), 6);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        for (int i = 0; i < 2; ++i) {
          for (int j = 0; j < 2; ++j) {
            const int ci = channels[static_cast<std::size_t>(i)], cj = channels[static_cast<std::size_t>(j)];
            EXPECT_DOUBLE_EQ(t(2 * a + i, 2 * b + j),
                             -expected(ci, cj, past ? b - a : a - b) / (scale[ci] * scale[cj]));
          }
        }
      }
    }
  }
}

TEST(BlockToeplitz, OfATrueProcessIsACovariance) {
  const test_support::RandomSystem system(3, 3, 2);
  const Correlations correlations = system.correlations(10);
  for (const bool past : {false, true}) {
    const Eigen::MatrixXd t = block_toeplitz(correlations, {0, 1}, Eigen::Vector2d::Ones(), 8, past);
    EXPECT_LT((t - t.transpose()).norm(), 1e-9 * t.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(t).eigenvalues().minCoeff(), -1e-9 * t.norm());
  }
}

}  // namespace
}  // namespace core
