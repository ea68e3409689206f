#include "core/identification/prewhitening.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

// Two channels of 1 Hz in white noise, 25 samples a second, with a slow drift.
CpsdSums record(double drift) {
  WelchConfig config;
  config.n_channels = 2;
  config.rate_hz = 25.0;
  WelchCpsd welch(config);
  std::mt19937 random(1);
  std::normal_distribution<double> gaussian;
  const std::vector<std::uint8_t> seen(2, 1);
  for (int k = 0; k < 5000; ++k) {
    const double t_s = k / 25.0, slow = drift * std::sin(2.0 * std::numbers::pi * 0.07 * t_s);
    const double swing = std::sin(2.0 * std::numbers::pi * t_s);
    welch.push(std::vector<double>{swing + slow + 0.1 * gaussian(random), 0.5 * swing + slow}, seen);
  }
  return welch.sums();
}

TEST(ChooseDifferences, OneAgainstDriftNoneWithout) {
  EXPECT_EQ(choose_differences(record(0.0), 12.5), 0);
  EXPECT_EQ(choose_differences(record(0.2), 12.5), 0);
  EXPECT_EQ(choose_differences(record(10.0), 12.5), 1);
}

TEST(ChooseDifferences, OneForModesAboveHalfTheRate) {
  EXPECT_EQ(choose_differences(record(0.0), 20.0), 1);
  EXPECT_EQ(choose_differences(record(0.0), 0.0), 0);
}

TEST(ChooseDifferences, NothingToJudgeNeedsNone) {
  EXPECT_EQ(choose_differences(CpsdSums{}, 12.5), 0);
  CpsdSums broken = record(0.0);
  for (auto& z : broken.data_sum) z = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(choose_differences(broken, 12.5), 0);
}

}  // namespace
}  // namespace core
