#include "core/identification/combination_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

constexpr double kRate = 100.0;

// One channel with lines at 7 Hz and at `other_hz`, the second of amplitude `share`.
CpsdSums lines(double other_hz, double share) {
  WelchConfig config;
  config.n_channels = 1, config.segment = 1024, config.rate_hz = kRate;
  WelchCpsd welch(config);
  std::mt19937 random(1);
  std::normal_distribution<double> gauss(0.0, 1e-4);
  for (int t = 0; t < 8192; ++t) {
    const double s = 2.0 * std::numbers::pi * t / kRate;
    welch.push(std::vector<double>{std::sin(7.0 * s) + share * std::sin(other_hz * s + 1.0) + gauss(random)},
               std::vector<std::uint8_t>{1});
  }
  welch.flush();
  return welch.sums();
}

Mode mode_at(double hz) {
  Mode mode;
  mode.frequency_hz = mode.apparent_hz = hz;
  mode.verdict = Verdict::kStructural;
  return mode;
}

std::vector<Mode> judged(double other_hz, double share) {
  std::vector<Mode> modes{mode_at(7.0), mode_at(other_hz)};
  reject_combinations(lines(other_hz, share), {ChannelInfo{}}, modes);
  return modes;
}

TEST(CombinationLines, AWeakExactMultipleIsAHarmonic) {
  EXPECT_EQ(judged(35.0, 0.01)[1].verdict, Verdict::kHarmonic);
  EXPECT_EQ(judged(35.0, 0.01)[0].verdict, Verdict::kStructural);
  EXPECT_NE(judged(35.0, 0.01)[1].reason.find("5 x 7 Hz"), std::string::npos);
}

TEST(CombinationLines, FoldedMultiplesAreFound) {
  const std::vector<Mode> modes = judged(44.0, 0.01);  // 8 x 7 = 56 = 100 - 44
  EXPECT_EQ(modes[1].verdict, Verdict::kHarmonic);
  EXPECT_NE(modes[1].reason.find("folded"), std::string::npos) << modes[1].reason;
}

TEST(CombinationLines, AStrongMultipleStaysAModeAndIsStated) {
  const std::vector<Mode> modes = judged(14.0, 0.2);
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
  EXPECT_NE(modes[1].reason.find("exactly 2 x 7 Hz"), std::string::npos) << modes[1].reason;
}

TEST(CombinationLines, WhatIsNotExactIsLeftAlone) {
  const std::vector<Mode> modes = judged(34.9, 0.01);
  EXPECT_EQ(modes[1].verdict, Verdict::kStructural);
  EXPECT_TRUE(modes[1].reason.empty());
}

}  // namespace
}  // namespace core
