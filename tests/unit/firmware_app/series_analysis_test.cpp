#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "firmware_app/replay/analysis.h"

namespace app {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Three channels, two modes at 1.5 and 4 Hz (1 % damping) driven by white noise, `rate_hz` samples a second; as
// accelerations: in units per sample squared.
ChannelSeries two_modes(double rate_hz, double duration_s, unsigned seed = 1, bool is_acceleration = false) {
  ChannelSeries series;
  series.rate_hz = rate_hz;
  const auto n = static_cast<std::size_t>(rate_hz * duration_s);
  series.value.assign(3, std::vector<double>(n));
  for (const char* name : {"low", "middle", "high"}) series.channels.emplace_back().name = name;
  for (core::ChannelInfo& channel : series.channels) channel.n_integrations = is_acceleration ? 2 : 0;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gaussian;
  double y[2][2] = {};
  for (std::size_t t = 0; t < n; ++t) {
    double modal[2];
    for (int m = 0; m < 2; ++m) {
      const double w = 2.0 * std::numbers::pi * (m == 0 ? 1.5 : 4.0) / rate_hz;
      const double r = std::exp(-0.01 * w);
      const double now = 2.0 * r * std::cos(w) * y[m][0] - r * r * y[m][1] + w * gaussian(random);
      modal[m] = is_acceleration ? now - 2.0 * y[m][0] + y[m][1] : now;
      y[m][1] = y[m][0];
      y[m][0] = now;
    }
    series.value[0][t] = 0.5 * modal[0] + 1.0 * modal[1] + 0.02 * gaussian(random);
    series.value[1][t] = 0.8 * modal[0] + 0.3 * modal[1] + 0.02 * gaussian(random);
    series.value[2][t] = 1.0 * modal[0] - 0.7 * modal[1] + 0.02 * gaussian(random);
  }
  return series;
}

SeriesOptions up_to(double max_frequency_hz) {
  SeriesOptions options;
  options.identifier.max_frequency_hz = max_frequency_hz;
  options.identifier.n_differences = 0;
  return options;
}

void expect_both_modes(const SeriesResult& result) {
  ASSERT_EQ(result.estimate.modes.size(), 2U) << result.estimate.status;
  EXPECT_NEAR(result.estimate.modes[0].frequency_hz, 1.5, 0.015);
  EXPECT_NEAR(result.estimate.modes[1].frequency_hz, 4.0, 0.03);
}

TEST(IdentifySeries, ARateFarAboveThatOfTheMotionIsRemarkedOn) {
  const auto remarks = identify_series(two_modes(400.0, 60.0), up_to(0.0)).remarks;
  EXPECT_THAT(remarks, Contains(AllOf(HasSubstr("far below half the rate of 400 Hz"), HasSubstr("--max-frequency"))));
  EXPECT_THAT(identify_series(two_modes(400.0, 60.0), up_to(8.0)).remarks, Not(Contains(HasSubstr("far below"))))
      << "where the limit is declared";
  EXPECT_THAT(identify_series(two_modes(20.0, 300.0), up_to(0.0)).remarks, Not(Contains(HasSubstr("far below"))));
}

// `factor` times the samples, without anything above the old half rate: interpolated by a windowed sinc.
ChannelSeries finer(const ChannelSeries& series, int factor) {
  constexpr int kReach = 16;
  ChannelSeries out = series;
  out.rate_hz *= factor;
  for (std::size_t c = 0; c < series.value.size(); ++c) {
    const auto& from = series.value[c];
    auto& to = out.value[c];
    to.assign(from.size() * static_cast<std::size_t>(factor), 0.0);
    for (std::size_t t = 0; t < to.size(); ++t) {
      const double at = static_cast<double>(t) / factor;
      for (int k = std::max(0, static_cast<int>(at) - kReach + 1); k <= static_cast<int>(at) + kReach; ++k) {
        if (k >= static_cast<int>(from.size())) break;
        const double x = std::numbers::pi * (at - k), window = std::cos(0.5 * x / kReach);
        to[t] += from[static_cast<std::size_t>(k)] * window * window * (x == 0.0 ? 1.0 : std::sin(x) / x);
      }
    }
  }
  return out;
}

TEST(IdentifySeries, ARecordFarAboveTheRateOfItsMotionIsDecimated) {
  const ChannelSeries white = two_modes(400.0, 300.0, 1, true), cut = finer(two_modes(100.0, 300.0, 1, true), 8);
  for (const ChannelSeries& series : {white, cut}) {  // noise up to half the rate, and cut at a sixteenth of the rate
    const SeriesResult result = identify_series(series, up_to(0.0));
    EXPECT_LT(result.estimate.rate_hz, 60.0) << series.rate_hz;
    EXPECT_GT(result.estimate.rate_hz, 10.0) << "the second mode stays in the passband";
    expect_both_modes(result);
    EXPECT_THAT(result.remarks, Contains(AllOf(HasSubstr("far below half the rate"), HasSubstr("--max-frequency"))));
  }
  EXPECT_EQ(identify_series(two_modes(20.0, 300.0), up_to(0.0)).decimation, 1);
}

TEST(IdentifySeries, NoiseAloneIsNotDecimated) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> gaussian;
  ChannelSeries noise = two_modes(400.0, 60.0);
  for (auto& values : noise.value) {
    for (double& value : values) value = gaussian(random);
  }
  EXPECT_EQ(identify_series(noise, up_to(0.0)).decimation, 1);
}

TEST(IdentifySeries, DecimatesToJustAboveTheWantedFrequency) {
  const SeriesResult result = identify_series(two_modes(200.0, 300.0), up_to(8.0));
  EXPECT_EQ(result.decimation, 10);
  EXPECT_EQ(result.estimate.rate_hz, 20.0);
  EXPECT_EQ(result.segment, 1024);
  expect_both_modes(result);
  EXPECT_THAT(result.remarks, Contains(HasSubstr("decimated by 10")));
  EXPECT_THAT(result.remarks, Contains(HasSubstr("segment of 1024 samples")));
}

TEST(IdentifySeries, GapsSurviveTheDecimation) {
  ChannelSeries series = two_modes(200.0, 300.0);
  for (std::size_t t = 10'000; t < 14'000; ++t) {
    for (auto& values : series.value) values[t] = kNaN;
  }
  const SeriesResult result = identify_series(series, up_to(8.0));
  EXPECT_GE(result.estimate.n_missing, 3U * 400U);
  EXPECT_LE(result.estimate.n_missing, 3U * 450U);
  expect_both_modes(result);
}

TEST(IdentifySeries, ConstantEmptyAndCopiedChannelsAreLeftOutAndNamed) {
  ChannelSeries series = two_modes(20.0, 300.0);
  const std::size_t n = series.value.front().size();
  std::vector<double> doubled = series.value[1];
  for (double& value : doubled) value = 5.0 - 2.0 * value;
  series.value.insert(series.value.begin(), std::vector<double>(n, 1234.5678));
  series.value.push_back(std::vector<double>(n, kNaN));
  series.value.push_back(doubled);
  series.channels.insert(series.channels.begin(), core::ChannelInfo{});
  series.channels.front().name = "stuck";
  series.channels.emplace_back().name = "dead";
  series.channels.emplace_back().name = "twice";
  SeriesOptions options = up_to(0.0);
  options.identifier.references = {0, 2, 3};
  const SeriesResult result = identify_series(series, options);
  ASSERT_EQ(result.channels.size(), 3U);
  EXPECT_EQ(result.channels[0].name, "low");
  EXPECT_THAT(result.remarks, Contains(HasSubstr("stuck is left out: it is constant (1234.57)")));
  EXPECT_THAT(result.remarks, Contains(HasSubstr("dead is left out: it has no sample")));
  EXPECT_THAT(result.remarks, Contains(HasSubstr("twice is left out: it is a copy or a multiple of middle")));
  expect_both_modes(result);
}

TEST(IdentifySeries, TheScaleOfTheValuesDoesNotMatter) {
  for (const double scale : {1e-12, 1.0, 1e12}) {
    ChannelSeries series = two_modes(20.0, 300.0);
    for (auto& values : series.value) {
      for (double& value : values) value *= scale;
    }
    expect_both_modes(identify_series(series, up_to(0.0)));
  }
}

TEST(IdentifySeries, WildOrdersOfMagnitudeAreLeftOut) {
  ChannelSeries series = two_modes(20.0, 300.0);
  for (const double scale : {1e80, 1e-80, 1e200, 1e-200, 1e30}) {
    series.channels.emplace_back().name = fmt::format("times {:g}", scale);
    series.value.push_back(series.value[0]);
    for (std::size_t t = 0; t < series.value.back().size(); ++t)
      series.value.back()[t] = scale * (series.value.back()[t] + 0.3 * series.value[1][t]);
  }
  const SeriesResult result = identify_series(series, up_to(0.0));
  EXPECT_EQ(result.channels.size(), 4U);
  expect_both_modes(result);
  for (const core::Mode& mode : result.estimate.rejected) EXPECT_TRUE(std::isfinite(mode.mpc));
  EXPECT_THAT(result.remarks, Contains(HasSubstr("times 1e+80 is left out")));
}

TEST(IdentifySeries, WhiteNoiseOfOneOrTwoChannelsHasNoMode) {
  for (const std::size_t n_channels : {1U, 2U}) {
    for (unsigned seed = 1; seed <= 8; ++seed) {
      std::mt19937_64 random(seed);
      std::normal_distribution<double> gaussian;
      ChannelSeries series;
      series.rate_hz = 20.0;
      series.channels.resize(n_channels);
      series.value.assign(n_channels, std::vector<double>(6000));
      for (auto& values : series.value) {
        for (double& value : values) value = gaussian(random);
      }
      EXPECT_TRUE(identify_series(series, up_to(0.0)).estimate.modes.empty()) << n_channels << " " << seed;
    }
  }
}

TEST(IdentifySeries, OneChannelIsAnsweredWithAWarning) {
  ChannelSeries series = two_modes(20.0, 300.0);
  series.channels.resize(1);
  series.value.resize(1);
  const SeriesResult result = identify_series(series, up_to(0.0));
  expect_both_modes(result);
  EXPECT_THAT(result.remarks, Contains(HasSubstr("one channel has no shape")));
}

TEST(IdentifySeries, RefusesWithTheReason) {
  const auto refusal = [](const ChannelSeries& series, const SeriesOptions& options) -> std::string {
    try {
      static_cast<void>(identify_series(series, options));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return {};
  };
  ChannelSeries series = two_modes(20.0, 2.0);
  EXPECT_THAT(refusal(series, up_to(0.0)), HasSubstr("fewer than one segment of 64"));
  for (auto& values : series.value) std::fill(values.begin(), values.end(), 2.0);
  EXPECT_THAT(refusal(series, up_to(0.0)), HasSubstr("no channel is left"));
  EXPECT_THAT(refusal({}, up_to(0.0)), HasSubstr("without channels"));
  series = two_modes(20.0, 60.0);
  series.value[1].pop_back();
  EXPECT_THAT(refusal(series, up_to(0.0)), HasSubstr("different lengths"));
  series = two_modes(20.0, 60.0);
  series.rate_hz = kNaN;
  EXPECT_THAT(refusal(series, up_to(0.0)), HasSubstr("rate"));
  series = two_modes(20.0, 60.0);
  series.value[2].assign(series.value[2].size(), 0.0);
  SeriesOptions options = up_to(0.0);
  options.identifier.references = {2};
  EXPECT_THAT(refusal(series, options), HasSubstr("no reference is left"));
}

TEST(IdentifySeries, AShortSegmentIsRemarkedOn) {
  SeriesOptions options = up_to(0.0);
  options.spectrum.segment = 128;
  EXPECT_THAT(identify_series(two_modes(20.0, 300.0), options).remarks, Contains(HasSubstr("shorter than 1.5 decay")));
  options.spectrum.segment = 2048;
  EXPECT_THAT(identify_series(two_modes(20.0, 300.0), options).remarks,
              Not(Contains(HasSubstr("shorter than 1.5 decay"))));
}

}  // namespace
}  // namespace app
