#include "core/identification/correlation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

struct Record {
  std::vector<std::vector<double>> x;  // channels x samples
  std::vector<std::vector<std::uint8_t>> seen;
};

Record noise(int n_channels, int n, unsigned seed, double loss) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian;
  std::uniform_real_distribution<double> unit;
  Record record{std::vector<std::vector<double>>(static_cast<std::size_t>(n_channels)),
                std::vector<std::vector<std::uint8_t>>(static_cast<std::size_t>(n_channels))};
  for (std::size_t c = 0; c < record.x.size(); ++c) {
    for (int t = 0; t < n; ++t) {
      record.x[c].push_back(gaussian(random));
      record.seen[c].push_back(unit(random) < loss ? 0 : 1);
    }
  }
  return record;
}

CpsdSums welch(const Record& record, int segment, WindowKind window = WindowKind::kBoxcar, double overlap = 0.0) {
  WelchConfig config;
  config.n_channels = static_cast<int>(record.x.size());
  config.segment = segment;
  config.overlap = overlap;
  config.window = window;
  config.rate_hz = 10.0;
  WelchCpsd estimate(config);
  std::vector<double> value(record.x.size());
  std::vector<std::uint8_t> seen(record.x.size());
  for (std::size_t t = 0; t < record.x.front().size(); ++t) {
    for (std::size_t c = 0; c < record.x.size(); ++c) {
      value[c] = record.x[c][t];
      seen[c] = record.seen[c][t];
    }
    estimate.push(value, seen);
  }
  return estimate.sums();
}

// One boxcar segment: the divided correlation is the plain average of the products of samples that were both seen.
TEST(Correlations, OfOneSegmentIsTheAverageOverSeenPairs) {
  const int n = 40;
  const Record record = noise(2, n, 3, 0.25);
  Correlations correlations;
  ASSERT_EQ(compute_correlations(welch(record, n), 20, 0, correlations), CorrelationStatus::kOk);
  std::vector<double> mean(2);
  for (std::size_t c = 0; c < 2; ++c) {
    double sum = 0.0, count = 0.0;
    for (std::size_t t = 0; t < n; ++t) sum += record.seen[c][t] * record.x[c][t], count += record.seen[c][t];
    mean[c] = sum / count;
  }
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      for (int lag = -20; lag <= 20; ++lag) {
        double sum = 0.0, count = 0.0;
        for (int t = std::max(0, -lag); t < std::min(n, n - lag); ++t) {
          const auto later = static_cast<std::size_t>(t + lag);
          const auto now = static_cast<std::size_t>(t);
          if (record.seen[i][later] == 0 || record.seen[j][now] == 0) continue;
          sum += (record.x[i][later] - mean[i]) * (record.x[j][now] - mean[j]);
          count += 1.0;
        }
        EXPECT_NEAR(correlations.divided(static_cast<int>(i), static_cast<int>(j), lag), sum / count, 1e-12)
            << i << j << " lag " << lag;
      }
    }
  }
}

TEST(Correlations, AreMirroredBetweenThePairsOrders) {
  Correlations correlations;
  ASSERT_EQ(compute_correlations(welch(noise(3, 200, 4, 0.1), 50), 15, 1, correlations), CorrelationStatus::kOk);
  for (int lag = -15; lag <= 15; ++lag) {
    EXPECT_EQ(correlations.divided(0, 2, lag), correlations.divided(2, 0, -lag));
    EXPECT_EQ(correlations.undivided(1, 2, lag), correlations.undivided(2, 1, -lag));
    EXPECT_NEAR(correlations.divided(1, 1, lag), correlations.divided(1, 1, -lag), 1e-12);
  }
}

TEST(Correlations, DividedAndUndividedAgreeAtLagZeroOfAChannel) {
  Correlations correlations;
  ASSERT_EQ(compute_correlations(welch(noise(2, 300, 5, 0.3), 64, WindowKind::kHann, 0.5), 10, 0, correlations),
            CorrelationStatus::kOk);
  for (int c = 0; c < 2; ++c) EXPECT_DOUBLE_EQ(correlations.divided(c, c, 0), correlations.undivided(c, c, 0));
}

// Differencing the signal means differencing its correlation twice; window and losses do not change that.
TEST(Correlations, DifferencesAreThoseOfTheLags) {
  const CpsdSums sums = welch(noise(2, 400, 6, 0.1), 64, WindowKind::kHann, 0.5);
  Correlations plain, differenced;
  ASSERT_EQ(compute_correlations(sums, 21, 0, plain), CorrelationStatus::kOk);
  ASSERT_EQ(compute_correlations(sums, 20, 1, differenced), CorrelationStatus::kOk);
  for (int lag = -20; lag <= 20; ++lag) {
    EXPECT_NEAR(differenced.divided(0, 1, lag),
                2.0 * plain.divided(0, 1, lag) - plain.divided(0, 1, lag - 1) - plain.divided(0, 1, lag + 1), 1e-12);
    EXPECT_NEAR(differenced.undivided(0, 1, lag),
                2.0 * plain.undivided(0, 1, lag) - plain.undivided(0, 1, lag - 1) - plain.undivided(0, 1, lag + 1),
                1e-12);
  }
}

TEST(Correlations, NeverReachBeyondHalfTheTransform) {
  Correlations correlations;
  (void)compute_correlations(welch(noise(1, 100, 7, 0.0), 16), 1000, 0, correlations);
  EXPECT_EQ(correlations.max_lag(), 15);
}

TEST(Correlations, SayWhyThereAreNone) {
  Correlations out;
  EXPECT_EQ(compute_correlations(welch(noise(1, 10, 1, 0.0), 16), 5, 0, out), CorrelationStatus::kNoSegment);
  EXPECT_EQ(compute_correlations(welch(noise(2, 64, 1, 1.0), 16), 5, 0, out), CorrelationStatus::kNoPower)
      << "all missing";

  Record silent = noise(2, 64, 1, 0.0);
  silent.x[1].assign(64, 0.0);
  EXPECT_EQ(compute_correlations(welch(silent, 16), 5, 1, out), CorrelationStatus::kNoPower) << "all zero";

  Record constant = noise(2, 640, 1, 0.0);
  constant.x[1].assign(640, 123.456);  // detrending leaves its rounding
  EXPECT_EQ(compute_correlations(welch(constant, 61, WindowKind::kHann, 0.5), 5, 1, out), CorrelationStatus::kNoPower)
      << "constant";

  Record alternating = noise(1, 320, 1, 0.0);
  for (std::size_t t = 0; t < 320; ++t) alternating.seen[0][t] = t % 2 == 0 ? 1 : 0;
  EXPECT_EQ(compute_correlations(welch(alternating, 32), 5, 0, out), CorrelationStatus::kTooFewSamples)
      << "odd lags never seen";

  CpsdSums broken = welch(noise(1, 64, 1, 0.0), 16);
  broken.data_sum[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compute_correlations(broken, 5, 0, out), CorrelationStatus::kNotFinite);
  broken.data_sum[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(compute_correlations(broken, 5, 0, out), CorrelationStatus::kNotFinite);

  for (const auto status : {CorrelationStatus::kNoSegment, CorrelationStatus::kNotFinite, CorrelationStatus::kNoPower,
                            CorrelationStatus::kTooFewSamples}) {
    EXPECT_GT(std::string(to_string(status)).size(), 10U);
  }
}

TEST(Correlations, OfNamedReferencesOnlyAreThoseOfAllPairs) {
  const CpsdSums sums = welch(noise(4, 200, 6, 0.0), 32);
  Correlations all, some;
  const std::vector<int> references{2};
  ASSERT_EQ(compute_correlations(sums, 10, 1, all), CorrelationStatus::kOk);
  ASSERT_EQ(compute_correlations(sums, 10, 1, some, references), CorrelationStatus::kOk);
  for (int c = 0; c < 4; ++c) {
    EXPECT_EQ(some.undivided(c, c, 0), all.undivided(c, c, 0));
    for (int lag = -10; lag <= 10; ++lag) EXPECT_EQ(some.divided(c, 2, lag), all.divided(c, 2, lag));
  }
  EXPECT_EQ(some.divided(0, 1, 3), 0.0);
}

// Channels that lose the same samples share one mask; one more lost sample in a channel gives it another mask.
TEST(Correlations, SharedAndSeparateMasksAgree) {
  Record record = noise(3, 400, 8, 0.1);
  record.seen[1] = record.seen[2] = record.seen[0];
  Correlations shared, separate;
  ASSERT_EQ(compute_correlations(welch(record, 40), 12, 0, shared), CorrelationStatus::kOk);
  CpsdSums sums = welch(record, 40);
  sums.mask_sum[1] *= 1.0 + 1e-15;
  ASSERT_EQ(compute_correlations(sums, 12, 0, separate), CorrelationStatus::kOk);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      for (int lag = -12; lag <= 12; ++lag) {
        EXPECT_NEAR(shared.divided(i, j, lag), separate.divided(i, j, lag), 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace core
