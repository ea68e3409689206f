#include "core/identification/steady_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "core/identification/identifier.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

using Complex = std::complex<double>;
constexpr double kRate_hz = 25.0, kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kChannels = 4;
const double kShape[kChannels] = {0.3, 0.6, 0.9, 1.0};
const double kLineShape[kChannels] = {0.2, -0.5, 0.4, 1.0};

// Modes in white noise; a line, or none; and what is lost.
struct Made {
  double seconds = 120.0, frequency_hz = 5.0, damping_ratio = 0.01;
  double line_hz = 0.0, line_mm = 0.0, wander = 0.0;  // wander: rms step of the line's phase per sample
  double lost = 0.0, forget_s = 0.0;
  int n_kept = 64;
  bool base_is_line = false;  // the first channel is the line alone
};

CpsdSums made(const Made& what, unsigned seed) {
  WelchConfig config;
  config.n_channels = kChannels;
  config.rate_hz = kRate_hz;
  config.n_kept_segments = what.n_kept;
  config.forget_s = what.forget_s;
  WelchCpsd welch(config);
  std::mt19937 random(seed);
  std::normal_distribution<double> gaussian;
  std::uniform_real_distribution<double> uniform;
  const Complex lambda = std::exp(Complex(-what.damping_ratio, 1.0) * kTwoPi * what.frequency_hz / kRate_hz);
  Complex state;
  for (int k = 0; k < 20000; ++k) state = lambda * state + gaussian(random);
  std::vector<double> value(kChannels);
  double phase = 0.4;
  for (int k = 0; k < static_cast<int>(what.seconds * kRate_hz); ++k) {
    state = lambda * state + gaussian(random);
    phase += kTwoPi * what.line_hz / kRate_hz + what.wander * gaussian(random);
    for (std::size_t c = 0; c < kChannels; ++c)
      value[c] = kShape[c] * state.real() + gaussian(random) + what.line_mm * kLineShape[c] * std::cos(phase);
    if (what.base_is_line) value[0] = what.line_mm * std::cos(phase) + 0.01 * gaussian(random);
    const std::vector<std::uint8_t> seen(kChannels, uniform(random) < what.lost ? 0 : 1);
    welch.push(value, seen);
  }
  welch.flush();
  return welch.sums();
}

std::vector<ChannelInfo> channels() {
  std::vector<ChannelInfo> out(kChannels);
  for (std::size_t c = 0; c < kChannels; ++c) out[c].name = "c" + std::to_string(c);
  return out;
}

std::vector<SteadyLine> lines_of(const CpsdSums& sums) { return find_steady_lines(sums, channels(), {}); }

double power(const CpsdSums& sums, double frequency_hz, std::size_t channel) {
  const auto bin = static_cast<std::size_t>(std::lround(frequency_hz * sums.n_fft / sums.rate_hz));
  const auto c = static_cast<int>(channel);
  return sums
      .data_sum[bin * static_cast<std::size_t>(sums.n_pairs()) +
                static_cast<std::size_t>(CpsdSums::pair_index(c, c, sums.n_channels))]
      .real();
}

TEST(SteadyLines, FrequencyAndAmplitudesOfALineAreEstimated) {
  const auto lines = lines_of(made({.line_hz = 3.217, .line_mm = 5.0}, 1));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0].apparent_hz, 3.217, 5e-4);
  EXPECT_GT(lines[0].coherence, 0.9);
  for (std::size_t c = 0; c < kChannels; ++c)  // 2 |a| is the amplitude, its sign that of the last channel's
    EXPECT_NEAR(2.0 * (lines[0].amplitude[c] / lines[0].amplitude[3]).real() * std::abs(lines[0].amplitude[3]),
                5.0 * kLineShape[c], 0.2);
}

TEST(SteadyLines, ALineOnTheFlankOfAModeIsFound) {
  int n_found = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto lines = lines_of(made({.seconds = 300.0, .line_hz = 5.2, .line_mm = 8.0}, seed));
    n_found += lines.size() == 1 && std::abs(lines[0].apparent_hz - 5.2) < 2e-3 ? 1 : 0;
  }
  EXPECT_GE(n_found, 9);
}

TEST(SteadyLines, NoModeAndNoNoiseIsALine) {
  int n_found = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    n_found += static_cast<int>(lines_of(made({.damping_ratio = 0.01}, seed)).size());
    n_found += static_cast<int>(lines_of(made({.damping_ratio = 0.001}, seed)).size());
    n_found += static_cast<int>(lines_of(made({.frequency_hz = 1.2, .damping_ratio = 0.001}, seed)).size());
  }
  EXPECT_LE(n_found, 2) << "in 60 records, three in a hundred of which may hold one by chance";
}

TEST(SteadyLines, ALineThatWandersIsNone) {
  EXPECT_TRUE(lines_of(made({.line_hz = 3.2, .line_mm = 2.0, .wander = 0.1}, 1)).empty());
}

TEST(SteadyLines, WithoutItsLineARecordHasThePowerThatItHadBefore) {
  for (const double lost : {0.0, 0.2}) {
    const CpsdSums without = made({.lost = lost}, 4);
    const CpsdSums with = made({.line_hz = 3.2, .line_mm = 3.0, .lost = lost}, 4);
    const CpsdSums freed = without_lines(with, lines_of(with));
    for (const double hz : {3.1, 3.17, 3.2, 3.23, 3.3}) {
      EXPECT_LT(power(freed, hz, 3), (lost > 0.0 ? 4.0 : 1.6) * power(without, hz, 3)) << hz << " Hz, lost " << lost;
      EXPECT_GT(power(freed, hz, 3), 0.4 * power(without, hz, 3)) << hz << " Hz, lost " << lost;
    }
    EXPECT_GT(power(with, 3.2, 3), 30.0 * power(without, 3.2, 3));
    EXPECT_EQ(power(freed, 8.0, 3), power(with, 8.0, 3)) << "far from the line nothing changes";
  }
}

TEST(SteadyLines, BlocksAddUpToTheSumsWithoutLines) {
  const CpsdSums with = made({.seconds = 300.0, .line_hz = 3.2, .line_mm = 3.0}, 5);
  const CpsdSums freed = without_lines(with, lines_of(with));
  double sum = 0.0;
  for (std::size_t b = 0; b < freed.n_blocks; ++b) {
    CpsdSums block = freed;
    block.data_sum = freed.blocks[b].data_sum;
    sum += power(block, 3.2, 2);
  }
  EXPECT_NEAR(sum, power(freed, 3.2, 2), 1e-6 * power(with, 3.2, 2));
}

// Segments that are no longer kept, and segments that weigh less: the line's power is taken from them.
TEST(SteadyLines, ALineIsTakenOutOfOlderSegmentsToo) {
  for (const double forget_s : {0.0, 200.0}) {
    const Made what{.seconds = 600.0, .line_hz = 3.2, .line_mm = 3.0, .forget_s = forget_s, .n_kept = 16};
    const CpsdSums with = made(what, 6);
    const auto lines = lines_of(with);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].n_segments, 15U) << "the last segment is shorter";
    EXPECT_LT(power(without_lines(with, lines), 3.2, 3), 0.05 * power(with, 3.2, 3)) << forget_s;
  }
}

TEST(SteadyLines, WhatAMeasuredInputExplainsIsNoLine) {
  const CpsdSums sums = made({.line_hz = 3.2, .line_mm = 3.0, .base_is_line = true}, 7);
  EXPECT_EQ(lines_of(sums).size(), 1U);
  EXPECT_TRUE(find_steady_lines(sums, channels(), {0}).empty());
}

TEST(SteadyLines, FewSegmentsHoldNoLine) {
  EXPECT_TRUE(lines_of(made({.seconds = 60.0, .line_hz = 3.2, .line_mm = 3.0}, 8)).empty());
  EXPECT_TRUE(lines_of(made({.line_hz = 3.2, .line_mm = 3.0, .n_kept = 0}, 8)).empty());
}

TEST(SteadyLines, TheModeBesideIsIdentifiedAsWithoutTheLine) {
  const auto identified = [](const Made& what) { return Identifier({}, channels()).identify(made(what, 9)); };
  const auto mode_of = [](const ModalEstimate& estimate) {
    std::optional<Mode> out;
    for (const Mode& mode : estimate.modes) {
      if (std::abs(mode.frequency_hz - 5.0) < 0.1) out = mode;
    }
    return out;
  };
  const ModalEstimate without = identified({.seconds = 300.0});
  const ModalEstimate with = identified({.seconds = 300.0, .line_hz = 5.2, .line_mm = 12.0});
  ASSERT_TRUE(mode_of(without) && mode_of(with));
  EXPECT_NEAR(mode_of(with)->frequency_hz, mode_of(without)->frequency_hz, 0.003);
  EXPECT_NEAR(mode_of(with)->damping_ratio, mode_of(without)->damping_ratio, 0.001);
  for (const Mode& mode : with.modes) EXPECT_GT(std::abs(mode.frequency_hz - 5.2), 0.05);
  int n_lines = 0;
  for (const Mode& pole : with.rejected) {
    if (pole.verdict != Verdict::kHarmonic) continue;
    ++n_lines;
    EXPECT_NEAR(pole.frequency_hz, 5.2, 1e-3);
    EXPECT_EQ(pole.shape.size(), kChannels);
    EXPECT_NE(pole.reason.find("steady line"), std::string::npos) << pole.reason;
  }
  EXPECT_EQ(n_lines, 1);
}

}  // namespace
}  // namespace core
