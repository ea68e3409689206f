#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <random>
#include <vector>

#include "core/identification/block_hankel.h"
#include "core/identification/correlation.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr int kMaxLag = 30;

WelchConfig config_of(int n_channels, int segment, WindowKind window) {
  WelchConfig config;
  config.n_channels = n_channels;
  config.segment = segment;
  config.window = window;
  config.rate_hz = 25.0;
  return config;
}

// Two resonators driven in part by the same noise; the second channel contains the first with a delay.
struct ArProcess {
  std::mt19937 random;
  std::normal_distribution<double> gaussian;
  double a1 = 0.0, a2 = 0.0, b1 = 0.0, b2 = 0.0;

  explicit ArProcess(unsigned seed) : random(seed) {}
  void next(std::vector<double>& x) {
    const double shared = gaussian(random);
    const double a = 1.55 * a1 - 0.9 * a2 + shared;
    const double b = 0.6 * b1 - 0.8 * b2 + 0.7 * a1 + gaussian(random);
    a2 = a1, a1 = a, b2 = b1, b1 = b;
    x[0] = a;
    x[1] = b;
  }
};

TEST(CpsdProperty, IsHermitianAndPositiveSemidefiniteWhateverIsMissing) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gaussian;
    const int n = 1 + static_cast<int>(random() % 4);
    WelchCpsd welch(config_of(n, 8 + static_cast<int>(random() % 60), static_cast<WindowKind>(random() % 3)));
    std::vector<double> x(static_cast<std::size_t>(n));
    std::vector<std::uint8_t> seen(x.size());
    for (int t = 0; t < 300; ++t) {
      for (std::size_t c = 0; c < x.size(); ++c) {
        x[c] = gaussian(random) + 0.5 * x[0];
        seen[c] = random() % 4 == 0 ? 0 : 1;
      }
      welch.push(x, seen);
    }
    welch.flush();
    const CpsdSums& sums = welch.sums();
    for (const auto* sum : {&sums.data_sum, &sums.mask_sum}) {
      for (int k = 0; k < sums.n_bins(); ++k) {
        Eigen::MatrixXcd s(n, n);
        for (int i = 0; i < n; ++i) {
          for (int j = i; j < n; ++j) {
            s(i, j) = (*sum)[static_cast<std::size_t>(k * sums.n_pairs() + CpsdSums::pair_index(i, j, n))];
            s(j, i) = std::conj(s(i, j));
          }
          ASSERT_EQ(s(i, i).imag(), 0.0);
        }
        const double smallest = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd>(s).eigenvalues().minCoeff();
        ASSERT_GT(smallest, -1e-12 * (1.0 + s.norm())) << "seed " << seed << " bin " << k;
      }
    }
  }
}

TEST(CpsdProperty, TheUndividedCorrelationStaysACovarianceUnderUnequalLosses) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    ArProcess process(seed);
    WelchCpsd welch(config_of(2, 128, WindowKind::kHann));
    std::vector<double> x(2);
    for (int t = 0; t < 2000; ++t) {
      process.next(x);
      welch.push(x, std::vector<std::uint8_t>{static_cast<std::uint8_t>(process.random() % 3 == 0 ? 0 : 1), 1});
    }
    Correlations correlations;
    ASSERT_EQ(compute_correlations(welch.sums(), kMaxLag, 1, correlations), CorrelationStatus::kOk);
    const Eigen::MatrixXd t = block_toeplitz(correlations, {0, 1}, Eigen::Vector2d::Ones(), 20, false);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(t).eigenvalues().minCoeff(), -1e-9 * t.norm());
  }
}

struct Pair {
  Correlations full, lossy;
};

Pair one_trial(unsigned seed, double loss) {
  ArProcess process(seed);
  std::uniform_real_distribution<double> unit;
  WelchCpsd full(config_of(2, 256, WindowKind::kHann));
  WelchCpsd lossy(config_of(2, 256, WindowKind::kHann));
  std::vector<double> x(2);
  const std::vector<std::uint8_t> all{1, 1};
  std::vector<std::uint8_t> some(2);
  for (int t = 0; t < 4096; ++t) {
    process.next(x);
    for (auto& s : some) s = unit(process.random) < loss ? 0 : 1;
    full.push(x, all);
    lossy.push(x, some);
  }
  Pair pair;
  EXPECT_EQ(compute_correlations(full.sums(), kMaxLag, 0, pair.full), CorrelationStatus::kOk);
  EXPECT_EQ(compute_correlations(lossy.sums(), kMaxLag, 0, pair.lossy), CorrelationStatus::kOk);
  return pair;
}

// Mean over trials of the change by losses, in units of its standard error. The segment's mean, estimated from fewer
// samples, removes a share of order 1 / segment of the variance: that much is allowed.
TEST(CpsdProperty, StaysUnbiasedUnderRandomLoss) {
  constexpr int kTrials = 40;
  for (const double loss : {0.1, 0.3}) {
    std::vector<double> sum(3 * (2 * kMaxLag + 1)), sum2(sum.size());
    double undivided_change = 0.0;
    for (unsigned trial = 0; trial < kTrials; ++trial) {
      const Pair pair = one_trial(1000 + trial, loss);
      std::size_t at = 0;
      for (int i = 0; i < 2; ++i) {
        for (int j = i; j < 2; ++j) {
          const double scale = std::sqrt(pair.full.divided(i, i, 0) * pair.full.divided(j, j, 0));
          for (int lag = -kMaxLag; lag <= kMaxLag; ++lag, ++at) {
            const double change = (pair.lossy.divided(i, j, lag) - pair.full.divided(i, j, lag)) / scale;
            sum[at] += change / kTrials;
            sum2[at] += change * change / kTrials;
          }
        }
      }
      undivided_change += (pair.lossy.undivided(0, 0, 1) / pair.full.undivided(0, 0, 1) - 1.0) / kTrials;
    }
    for (std::size_t at = 0; at < sum.size(); ++at) {
      const double standard_error = std::sqrt((sum2[at] - sum[at] * sum[at]) / (kTrials - 1));
      EXPECT_LT(std::abs(sum[at]), 4.5 * standard_error + loss / 256.0) << "loss " << loss << " at " << at;
    }
    EXPECT_NEAR(undivided_change, -loss, 0.02) << "without the mask the loss would show: this test can fail";
  }
}

}  // namespace
}  // namespace core
