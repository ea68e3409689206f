#include "drivers/camera/recording/time_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace drivers {
namespace {

std::vector<std::int64_t> ns(const std::vector<double>& t_s) {
  std::vector<std::int64_t> out;
  for (const double t : t_s) out.push_back(std::llround(t * 1e9));
  return out;
}

TEST(TimeFit, TakesTheStatedRateToTheLastBitWhereTheTimesAgree) {
  std::vector<double> t_s;
  for (int i = 0; i < 500; ++i) t_s.push_back(i * 1001.0 / 30000.0);
  const std::vector<double> stated{30.0, 30000.0 / 1001.0};
  const TimeFit fit = fit_times(ns(t_s), 1e-5, stated);
  EXPECT_EQ(fit.rate_hz, 30000.0 / 1001.0);
  EXPECT_TRUE(fit.is_even);
  EXPECT_EQ(fit.n_lost, 0U);
}

TEST(TimeFit, IsNotMovedByTimesInWholeMilliseconds) {
  std::vector<double> t_s;
  for (int i = 0; i < 2000; ++i) t_s.push_back(std::round(i / 0.24) * 1e-3);
  const TimeFit fit = fit_times(ns(t_s), 1e-3, {});
  EXPECT_NEAR(fit.rate_hz, 240.0, 1e-3);
  EXPECT_EQ(fit.n_lost, 0U);
  EXPECT_TRUE(fit.is_even);
}

TEST(TimeFit, CountsLostFramesExactlyUnderJitter) {
  for (int seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> jitter(0.0, 0.002);
    std::bernoulli_distribution is_lost(0.2);
    std::vector<double> t_s;
    std::uint64_t n_lost = 0, pending = 0;
    for (int i = 0; i < 1500; ++i) {
      if (i > 0 && is_lost(random)) {
        ++pending;
        continue;
      }
      n_lost += std::exchange(pending, 0);
      t_s.push_back(i / 29.87 + std::clamp(jitter(random), -0.01, 0.01));
    }
    const TimeFit fit = fit_times(ns(t_s), 1e-6, std::vector<double>{30.0, 23.9});
    EXPECT_EQ(fit.n_lost, n_lost) << seed;
    EXPECT_NEAR(fit.rate_hz, 29.87, 1e-3) << seed;
    EXPECT_NEAR(fit.jitter_s, 0.002, 2e-4) << seed;
    EXPECT_FALSE(fit.is_even);
    EXPECT_FALSE(fit.change.has_value()) << seed;
  }
}

TEST(TimeFit, FindsTheGridWhenMostFramesAreLost) {
  std::mt19937 random(3);
  std::bernoulli_distribution is_kept(0.4);
  std::vector<double> t_s;
  for (int i = 0; i < 2000; ++i) {
    if (is_kept(random)) t_s.push_back(i * 0.04);
  }
  EXPECT_NEAR(fit_times(ns(t_s), 1e-5, {}).rate_hz, 25.0, 1e-6);
}

TEST(TimeFit, HalfTheRateForAWhileIsNoChange) {
  std::vector<double> t_s;
  for (int i = 0; i < 900; ++i) {
    if (i < 300 || i > 600 || i % 2 == 0) t_s.push_back(i / 30.0);
  }
  const TimeFit fit = fit_times(ns(t_s), 1e-5, {});
  EXPECT_FALSE(fit.change.has_value());
  EXPECT_NEAR(fit.rate_hz, 30.0, 1e-6);
  EXPECT_EQ(fit.n_lost, 150U);
}

TEST(TimeFit, SeesAChangeOfRate) {
  for (const double other_hz : {24.0, 30.0, 24.75, 50.0 / 1.5}) {
    std::vector<double> t_s;
    for (int i = 0; i < 400; ++i) t_s.push_back(i < 250 ? i / 25.0 : 10.0 + (i - 250) / other_hz);
    const TimeFit fit = fit_times(ns(t_s), 1e-5, std::vector<double>{25.0});
    ASSERT_TRUE(fit.change.has_value()) << other_hz;
    EXPECT_NEAR(fit.change->before_hz, 25.0, 0.01);
    EXPECT_NEAR(fit.change->after_hz, other_hz, 0.01);
    EXPECT_NEAR(fit.change->at_s, 10.0, 2.5);
  }
}

TEST(TimeFit, SaysNothingOfOneTimeOrOfEqualOnes) {
  EXPECT_EQ(fit_times({}, 1e-3, {}).rate_hz, 0.0);
  EXPECT_EQ(fit_times(std::vector<std::int64_t>{5}, 1e-3, {}).rate_hz, 0.0);
  EXPECT_EQ(fit_times(std::vector<std::int64_t>{5, 5, 5}, 1e-3, {}).rate_hz, 0.0);
}

TEST(TimeFit, AnyRisingTimesGiveRisingCells) {
  std::mt19937_64 random(11);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::int64_t> times_ns{0};
    std::lognormal_distribution<double> step(17.0, round % 10);
    for (int i = 0; i < 80; ++i) {
      times_ns.push_back(times_ns.back() + static_cast<std::int64_t>(std::min(step(random), 1e16)));
    }
    const TimeFit fit = fit_times(times_ns, 1e-9, {});
    ASSERT_EQ(fit.cells.size(), times_ns.size());
    EXPECT_EQ(fit.cells.front(), 0U);
    EXPECT_TRUE(std::is_sorted(fit.cells.begin(), fit.cells.end()));
    EXPECT_TRUE(std::isfinite(fit.rate_hz) && fit.rate_hz > 0.0);
  }
}

}  // namespace
}  // namespace drivers
