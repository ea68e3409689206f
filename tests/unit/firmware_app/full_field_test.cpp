#include "firmware_app/replay/full_field.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace app {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kRate_hz = 30.0;

double true_component(std::size_t mode, std::size_t channel, std::size_t n_channels) {
  const double place = static_cast<double>(channel + 1) / static_cast<double>(n_channels);
  return std::sin((static_cast<double>(mode) + 0.5) * std::numbers::pi * place);
}

// A cantilever-like row of channels in three modes of 2, 5 and 9 Hz, 1 % damping, under white noise, for 200 s.
ChannelSeries row_of(std::size_t n_channels) {
  ChannelSeries series;
  series.rate_hz = kRate_hz;
  const std::size_t n = 6000;
  series.value.assign(n_channels, std::vector<double>(n));
  for (std::size_t c = 0; c < n_channels; ++c) series.channels.emplace_back().name = fmt::format("p{}", c);
  std::mt19937_64 random(7);
  std::normal_distribution<double> gaussian;
  constexpr double kHz[] = {2.0, 5.0, 9.0};
  double y[3][2] = {}, modal[3];
  for (std::size_t t = 0; t < n; ++t) {
    for (std::size_t m = 0; m < 3; ++m) {
      const double w = 2.0 * std::numbers::pi * kHz[m] / kRate_hz, r = std::exp(-0.01 * w);
      modal[m] = 2.0 * r * std::cos(w) * y[m][0] - r * r * y[m][1] + gaussian(random);
      y[m][1] = y[m][0], y[m][0] = modal[m];
    }
    for (std::size_t c = 0; c < n_channels; ++c) {
      double sum = 0.1 * gaussian(random);
      for (std::size_t m = 0; m < 3; ++m) sum += true_component(m, c, n_channels) * modal[m];
      series.value[c][t] = sum;
    }
  }
  return series;
}

TEST(FullField, EveryChannelOfManyHasItsComponentWithASigma) {
  constexpr std::size_t kChannels = 60;
  const SeriesResult result = identify_series(row_of(kChannels), {});
  ASSERT_EQ(result.estimate.modes.size(), 3U) << result.estimate.status;
  ASSERT_EQ(result.channels.size(), kChannels);
  ASSERT_EQ(result.estimate.channels.size(), kChannels);
  EXPECT_THAT(result.remarks, Contains(HasSubstr("from 12 of 60 channels")));
  for (std::size_t m = 0; m < 3; ++m) {
    const core::Mode& mode = result.estimate.modes[m];
    ASSERT_EQ(mode.shape.size(), kChannels);
    ASSERT_EQ(mode.shape_std.size(), kChannels);
    double inner = 0.0, own = 0.0, truth = 0.0, largest = 0.0;
    for (std::size_t c = 0; c < kChannels; ++c) {
      const double x = mode.shape[c].real(), y = true_component(m, c, kChannels);
      inner += x * y, own += x * x, truth += y * y;
      largest = std::max(largest, std::abs(mode.shape[c]));
      EXPECT_LT(mode.shape_std[c], 0.1);
    }
    EXPECT_GT(inner * inner / (own * truth), 0.999) << mode.frequency_hz;
    EXPECT_NEAR(largest, 1.0, 1e-12);
  }
}

TEST(FullField, ACopyOfAChannelAmongManyIsStillLeftOut) {
  ChannelSeries series = row_of(30);
  series.value[20] = series.value[3];
  for (double& value : series.value[20]) value *= -2.5;
  const SeriesResult result = identify_series(series, {});
  EXPECT_EQ(result.channels.size(), 29U);
  EXPECT_THAT(result.remarks, Contains(HasSubstr("copy or a multiple of p3")));
}

TEST(FullField, TheCoreHoldsBasesAndReferencesAndThenWhatMovesMost) {
  ChannelSeries series = row_of(40);
  series.channels[5].is_base = true;
  const FieldCore automatic = choose_core(series, {});
  EXPECT_EQ(automatic.channels.size(), 12U);
  EXPECT_EQ(automatic.references.size(), 6U);
  EXPECT_THAT(automatic.channels, Contains(5U));
  for (const int r : automatic.references) EXPECT_NE(automatic.channels[static_cast<std::size_t>(r)], 5U);
  const FieldCore asked = choose_core(series, {7, 9});
  ASSERT_EQ(asked.references.size(), 2U);
  EXPECT_EQ(asked.channels[static_cast<std::size_t>(asked.references[0])], 7U);
  EXPECT_EQ(asked.channels[static_cast<std::size_t>(asked.references[1])], 9U);
}

TEST(FullField, AChannelWithManyGapsIsNotInTheCore) {
  ChannelSeries series = row_of(40);
  for (std::size_t t = 0; t < series.value[39].size(); t += 4) series.value[39][t] = std::nan("");
  EXPECT_THAT(choose_core(series, {}).channels, ::testing::Not(Contains(39U)));
  const SeriesResult result = identify_series(series, {});
  ASSERT_EQ(result.estimate.modes.size(), 3U);
  EXPECT_NEAR(result.estimate.channels[39].seen, 0.75, 0.01);
  EXPECT_NEAR(result.estimate.modes[0].shape[39].real(), 1.0, 0.05);
}

TEST(FullField, AChannelThatIsHardlySeenIsUnknownAndItsNeighboursAreNot) {
  ChannelSeries series = row_of(40);
  for (std::size_t t = 600; t < series.value[20].size(); ++t) series.value[20][t] = std::nan("");
  const SeriesResult result = identify_series(series, {});
  ASSERT_EQ(result.estimate.modes.size(), 3U);
  EXPECT_FALSE(result.estimate.channels[20].takes_part);
  EXPECT_THAT(result.estimate.channels[20].reason, HasSubstr("10 %"));
  EXPECT_NEAR(result.estimate.modes[0].shape[21].real(), true_component(0, 21, 40), 0.05);
}

TEST(FullField, AShortRecordHasShapesOfAllChannelsOrNone) {
  ChannelSeries series = row_of(30);
  for (auto& values : series.value) values.resize(600);
  const SeriesResult result = identify_series(series, {});
  EXPECT_EQ(result.channels.size(), 30U);
  for (const core::Mode& mode : result.estimate.modes) EXPECT_EQ(mode.shape.size(), 30U);
  for (const core::Mode& mode : result.estimate.rejected) EXPECT_EQ(mode.shape.size(), 30U);
}

}  // namespace
}  // namespace app
