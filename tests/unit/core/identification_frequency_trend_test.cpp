#include "core/identification/frequency_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/simulation/random_stream.h"

namespace core {
namespace {

constexpr double kFirstS = 40.0, kStepS = 10.0;
constexpr int kEstimates = 57;           // 600 s
constexpr double kVarianceTime = 0.008;  // Hz^2 s: a mode of 5 Hz and 1 % damping

// Estimates of a frequency 5 Hz + drift t whose scatter is that of a growing average: Var = c^2 / T.
template <class Use>
void each_estimate(std::uint64_t seed, double drift_hz_per_s, double scatter, Use&& use) {
  simulation::RandomStream random(seed, "trend");
  double integral = 0.0, before_s = 0.0;
  for (int k = 0; k < kEstimates; ++k) {
    const double record_s = kFirstS + kStepS * k;
    const double piece_s = record_s - before_s;
    integral += (5.0 + drift_hz_per_s * 0.5 * (record_s + before_s)) * piece_s;
    integral += scatter * std::sqrt(kVarianceTime * piece_s) * random.gaussian();
    before_s = record_s;
    use(integral / record_s, record_s);
  }
}

TEST(FrequencyTrend, FindsALinearDriftExactly) {
  FrequencyTrend trend;
  each_estimate(1, -2e-5, 0.0, [&](double f, double t) { trend.add(f, t); });
  const auto slope = trend.slope(kVarianceTime);
  ASSERT_TRUE(slope);
  EXPECT_NEAR(slope->hz_per_s, -2e-5, 1e-12);
}

TEST(FrequencyTrend, StatesTheScatterOfItsSlope) {
  constexpr int kSeeds = 400;
  double sum = 0.0, sum_of_squares = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    FrequencyTrend trend;
    each_estimate(seed, 1e-5, 1.0, [&](double f, double t) { trend.add(f, t); });
    const auto slope = trend.slope(kVarianceTime);
    ASSERT_TRUE(slope);
    const double z = (slope->hz_per_s - 1e-5) / slope->std_hz_per_s;
    sum += z;
    sum_of_squares += z * z;
  }
  EXPECT_NEAR(sum / kSeeds, 0.0, 3.0 / std::sqrt(kSeeds));  // no bias
  const double spread = std::sqrt(sum_of_squares / kSeeds);
  EXPECT_LT(spread, 1.0 + 3.0 / std::sqrt(2.0 * kSeeds));  // sigmas are never too small
  EXPECT_GT(spread, 0.8);  // larger residuals increase sigma, smaller ones do not decrease it: slightly conservative
}

// Why shared data must be considered: a line through the estimates themselves takes their common noise for a drift.
TEST(FrequencyTrend, DoesNotTakeSharedNoiseForADrift) {
  constexpr int kSeeds = 200;
  int n_ours = 0, n_naive = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    FrequencyTrend trend;
    double n = 0.0, t1 = 0.0, f1 = 0.0, tt = 0.0, tf = 0.0, ff = 0.0;
    each_estimate(seed, 0.0, 1.0, [&](double f, double t) {
      trend.add(f, t);
      f -= 5.0;
      n += 1.0, t1 += t, f1 += f, tt += t * t, tf += t * f, ff += f * f;
    });
    const auto slope = trend.slope(kVarianceTime);
    ASSERT_TRUE(slope);
    n_ours += std::abs(slope->hz_per_s) > 4.0 * slope->std_hz_per_s ? 1 : 0;
    const double s_tt = tt - t1 * t1 / n, s_tf = tf - t1 * f1 / n, s_ff = ff - f1 * f1 / n;
    const double residual = (s_ff - s_tf * s_tf / s_tt) / (n - 2.0);
    n_naive += std::abs(s_tf / s_tt) > 4.0 * std::sqrt(residual / s_tt) ? 1 : 0;
  }
  EXPECT_EQ(n_ours, 0);
  EXPECT_GT(n_naive, kSeeds / 2);
}

TEST(FrequencyTrend, BelievesResidualsThatScatterMore) {
  FrequencyTrend calm, wild;
  each_estimate(3, 0.0, 1.0, [&](double f, double t) { calm.add(f, t); });
  each_estimate(3, 0.0, 5.0, [&](double f, double t) { wild.add(f, t); });
  EXPECT_GT(wild.slope(kVarianceTime)->std_hz_per_s, 3.0 * calm.slope(kVarianceTime)->std_hz_per_s);
}

TEST(FrequencyTrend, NeedsThreePiecesAndARecordThatGrows) {
  FrequencyTrend trend;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(trend.slope(kVarianceTime));
  trend.add(5.0, 10.0);
  trend.add(5.1, 10.0);  // the same record again
  trend.add(nan, 20.0);
  trend.add(5.0, nan);
  trend.add(5.1, 30.0);
  EXPECT_EQ(trend.n_pieces(), 2U);
  EXPECT_FALSE(trend.slope(kVarianceTime));
  trend.add(5.0, 40.0);
  ASSERT_TRUE(trend.slope(kVarianceTime));
  EXPECT_TRUE(std::isfinite(trend.slope(kVarianceTime)->hz_per_s));
  trend.restart();
  EXPECT_FALSE(trend.slope(kVarianceTime));
}

}  // namespace
}  // namespace core
