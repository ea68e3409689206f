#include "core/spectrum/gap_taper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

TEST(GapWeights, RiseBesideALongGapOnly) {
  std::vector<std::uint8_t> seen(100, 1);
  std::vector<double> weight(100);
  EXPECT_FALSE(gap_weights(seen, weight));
  EXPECT_EQ(weight, std::vector<double>(100, 1.0));
  for (std::size_t t = 40; t < 52; ++t) seen[t] = 0;
  seen[80] = 0;
  EXPECT_TRUE(gap_weights(seen, weight));
  EXPECT_EQ(weight[40], 0.0);
  EXPECT_EQ(weight[51], 0.0);
  EXPECT_EQ(weight[27], 1.0);
  EXPECT_EQ(weight[64], 1.0);
  EXPECT_NEAR(weight[39], std::pow(std::sin(std::numbers::pi / 26.0), 2), 1e-12);
  for (std::size_t k = 0; k < 12; ++k) {
    EXPECT_LT(weight[39 - k], k == 11 ? 1.0 : weight[38 - k]);
    EXPECT_DOUBLE_EQ(weight[39 - k], weight[52 + k]);
  }
  EXPECT_EQ(weight[79], 1.0);
  EXPECT_EQ(weight[80], 0.0);
}

TEST(GapWeights, AGapAtTheEndOfTheSegmentHasOneSide) {
  std::vector<std::uint8_t> seen(60, 1);
  for (std::size_t t = 48; t < 60; ++t) seen[t] = 0;
  std::vector<double> weight(60);
  EXPECT_TRUE(gap_weights(seen, weight));
  EXPECT_GT(weight[47], 0.0);
  EXPECT_LT(weight[47], 0.1);
  EXPECT_EQ(weight[0], 1.0);
}

// Power at 8 Hz of a hover that has none there, beside one lost second: less than of 0.02 px of vibration.
TEST(GapWeights, ALostSecondDoesNotSpreadTheHover) {
  WelchConfig config;
  config.segment = 256, config.rate_hz = 25.0, config.bridge_losses = true;
  const auto power_at_8_hz = [&](double hover_px, double vibration_px) {
    WelchCpsd welch(config);
    for (int t = 0; t < 256; ++t) {
      const double s = t / 25.0;
      const double x = hover_px * std::sin(2.0 * std::numbers::pi * 0.21 * s + 0.4) +
                       vibration_px * std::sin(2.0 * std::numbers::pi * 8.0 * s);
      const std::uint8_t seen = t >= 100 && t < 125 ? 0 : 1;
      (void)welch.push(std::vector<double>{x}, std::vector<std::uint8_t>{seen});
    }
    const CpsdSums& sums = welch.sums();
    return std::abs(sums.data_sum[static_cast<std::size_t>(std::lround(8.0 * sums.n_fft / 25.0))]);
  };
  EXPECT_LT(power_at_8_hz(20.0, 0.0), power_at_8_hz(0.0, 0.02));
}

}  // namespace
}  // namespace core
