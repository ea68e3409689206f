#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include "core/identification/identifier.h"
#include "core/spectrum/welch_cpsd.h"

namespace core {
namespace {

const double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Input {
  int n_channels = 3;
  int n = 3000;
  int segment = 256;
};

// value(channel, sample): not finite = not seen.
CpsdSums spectra(const Input& input, const std::function<double(int, int)>& value) {
  WelchConfig config;
  config.n_channels = input.n_channels;
  config.segment = input.segment;
  config.rate_hz = 25.0;
  WelchCpsd welch(config);
  std::vector<double> x(static_cast<std::size_t>(input.n_channels));
  const std::vector<std::uint8_t> seen(x.size(), 1);
  for (int t = 0; t < input.n; ++t) {
    for (int c = 0; c < input.n_channels; ++c) x[static_cast<std::size_t>(c)] = value(c, t);
    welch.push(x, seen);
  }
  welch.flush();
  return welch.sums();
}

double noise(int c, int t) {
  std::mt19937 random(static_cast<unsigned>(c * 1000003 + t));
  return std::normal_distribution<double>()(random);
}

void expect_all_finite(const ModalEstimate& estimate) {
  EXPECT_TRUE(std::isfinite(estimate.duration_s) && std::isfinite(estimate.rate_hz));
  for (const auto* list : {&estimate.modes, &estimate.rejected}) {
    for (const Mode& mode : *list) {
      EXPECT_TRUE(std::isfinite(mode.frequency_hz) && std::isfinite(mode.apparent_hz) &&
                  std::isfinite(mode.damping_ratio) && std::isfinite(mode.mpc) && std::isfinite(mode.presence))
          << mode.reason;
      EXPECT_TRUE(std::isfinite(mode.frequency_std_hz.value_or(0.0)) && std::isfinite(mode.damping_std.value_or(0.0)) &&
                  std::isfinite(mode.fold_margin.value_or(0.0)));
      EXPECT_FALSE(mode.reason.empty());
      for (const auto& z : mode.shape) EXPECT_TRUE(std::isfinite(z.real()) && std::isfinite(z.imag()));
      for (const double s : mode.shape_std) EXPECT_TRUE(std::isfinite(s));
    }
  }
}

ModalEstimate identify(const CpsdSums& sums, IdentifierConfig config = {}) {
  std::vector<ChannelInfo> channels(static_cast<std::size_t>(sums.n_channels));
  for (std::size_t c = 0; c < channels.size(); ++c) channels[c].row_delay_s = 0.005 * static_cast<double>(c);
  const ModalEstimate estimate = Identifier(config, channels).identify(sums);
  expect_all_finite(estimate);
  EXPECT_FALSE(estimate.status.empty());
  return estimate;
}

void expect_refused(const CpsdSums& sums) {
  const ModalEstimate estimate = identify(sums);
  EXPECT_NE(estimate.status, "ok");
  EXPECT_TRUE(estimate.modes.empty());
  EXPECT_TRUE(estimate.rejected.empty());
  EXPECT_EQ(estimate.n_samples, sums.n_samples);
}

TEST(IdentifierHostile, BeforeTheFirstSegmentItSaysSo) {
  WelchConfig config;
  config.n_channels = 2;
  expect_refused(WelchCpsd::empty_sums(config));
}

TEST(IdentifierHostile, AllChannelsZero) {
  expect_refused(spectra({}, [](int, int) { return 0.0; }));
}

TEST(IdentifierHostile, AllMissing) {
  expect_refused(spectra({}, [](int, int) { return kNaN; }));
}

TEST(IdentifierHostile, OneChannelConstant) {
  for (const double constant : {0.0, 3.7, 1234.567}) {
    expect_refused(spectra({}, [=](int c, int t) { return c == 1 ? constant : noise(c, t); }));
  }
}

TEST(IdentifierHostile, OneChannelMissingTakesNoPartAndIsNamed) {
  const ModalEstimate estimate = identify(spectra({}, [](int c, int t) { return c == 1 ? kNaN : noise(c, t); }));
  EXPECT_EQ(estimate.status, "ok");
  ASSERT_GE(estimate.channels.size(), 2U);
  EXPECT_TRUE(estimate.channels[0].takes_part);
  EXPECT_FALSE(estimate.channels[1].takes_part);
  EXPECT_FALSE(estimate.channels[1].reason.empty());
}

TEST(IdentifierHostile, NaNInTheSpectra) {
  CpsdSums sums = spectra({}, noise);
  sums.data_sum[100] = kNaN;
  expect_refused(sums);
}

TEST(IdentifierHostile, ValuesTooLargeToSquare) {
  expect_refused(spectra({}, [](int c, int t) { return 1e200 * noise(c, t); }));
}

TEST(IdentifierHostile, WhiteNoiseHasNoStructuralMode) {
  const ModalEstimate estimate = identify(spectra({}, noise));
  EXPECT_TRUE(estimate.modes.empty()) << estimate.modes.front().reason;
}

TEST(IdentifierHostile, OneChannel) {
  const ModalEstimate estimate =
      identify(spectra({1, 3000, 256}, [](int, int t) { return noise(0, t) + std::sin(0.8 * t); }));
  EXPECT_EQ(estimate.status, "ok");
}

TEST(IdentifierHostile, OneSegment) { identify(spectra({3, 256, 256}, noise)); }
TEST(IdentifierHostile, LessThanOneSegment) { identify(spectra({3, 40, 256}, noise)); }
TEST(IdentifierHostile, OneSample) { identify(spectra({3, 1, 256}, noise)); }
TEST(IdentifierHostile, TheShortestSegment) { identify(spectra({2, 100, 4}, noise)); }

TEST(IdentifierHostile, IdenticalChannels) {
  identify(spectra({}, [](int, int t) { return noise(0, t); }));
}

TEST(IdentifierHostile, APureSineWithoutNoise) {
  identify(spectra({}, [](int c, int t) { return (1.0 + c) * std::sin(0.9 * t); }));
}

TEST(IdentifierHostile, AnImpulse) {
  identify(spectra({}, [](int c, int t) { return t == 1000 ? 1.0 + c : 0.0; }));
}

TEST(IdentifierHostile, AStaircase) {
  identify(spectra({}, [](int c, int t) { return static_cast<double>((c + 1) * (t / 500)); }));
}

TEST(IdentifierHostile, MostSamplesMissing) {
  identify(spectra({}, [](int c, int t) { return noise(c + 7, t) > 1.3 ? noise(c, t) : kNaN; }));
}

TEST(IdentifierHostile, SettingsBeyondReason) {
  const CpsdSums sums = spectra({}, noise);
  IdentifierConfig config;
  config.max_order = 1;
  identify(sums, config);
  config.max_order = 100000;
  identify(sums, config);
  config.block_rows = 1;
  identify(sums, config);
  config.block_rows = 5000;  // more lags than the segment has
  identify(sums, config);
  config = {};
  config.references = {1, 1, 1};
  identify(sums, config);
  config = {};
  config.max_frequency_hz = 500.0;
  identify(sums, config);
}

}  // namespace
}  // namespace core
