#include "firmware_app/replay/series_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Two channels of coloured noise, 20 samples a second.
ChannelSeries two_channels(std::size_t n = 2000) {
  ChannelSeries series;
  series.rate_hz = 20.0;
  series.value.assign(2, std::vector<double>(n));
  for (const char* name : {"left", "right"}) series.channels.emplace_back().name = name;
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  for (auto& values : series.value) {
    double a = 0.0, b = 0.0;
    for (double& x : values) {
      x = 1.9 * std::cos(0.5) * a - 0.92 * b + gauss(random);
      b = a, a = x;
    }
  }
  return series;
}

std::size_t n_missing(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double x) { return std::isnan(x); }));
}

TEST(SeriesFaults, ACleanRecordStaysAsItIs) {
  ChannelSeries series = two_channels(20'000);
  const ChannelSeries before = series;
  std::vector<std::string> remarks;
  EXPECT_THAT(mask_faults(series, remarks), ElementsAre(0, 0));
  EXPECT_THAT(remarks, IsEmpty());
  EXPECT_EQ(series.value, before.value);
}

TEST(SeriesFaults, FillValuesAreMissingAndNamed) {
  for (const double fill : {-9999.0, 9.91e37, 1e6}) {
    ChannelSeries series = two_channels();
    for (const std::size_t t : {300U, 301U, 302U, 900U}) series.value[0][t] = fill;
    std::vector<std::string> remarks;
    (void)mask_faults(series, remarks);
    EXPECT_EQ(n_missing(series.value[0]), 4U) << fill;
    EXPECT_EQ(n_missing(series.value[1]), 0U);
    ASSERT_EQ(remarks.size(), 1U);
    EXPECT_THAT(remarks[0], HasSubstr("left: 4 samples of"));
    EXPECT_THAT(remarks[0], HasSubstr("first at 15 s"));
    EXPECT_THAT(remarks[0], HasSubstr("a fill value"));
  }
}

TEST(SeriesFaults, TwoFillValuesOfOneChannelAreBothFound) {
  ChannelSeries series = two_channels();
  series.value[1][100] = 9.91e37, series.value[1][200] = -9999.0;
  std::vector<std::string> remarks;
  (void)mask_faults(series, remarks);
  EXPECT_EQ(n_missing(series.value[1]), 2U);
  EXPECT_EQ(remarks.size(), 2U);
}

TEST(SeriesFaults, AStuckStretchIsMissingWhereOthersMove) {
  ChannelSeries series = two_channels();
  std::fill(series.value[0].begin() + 1000, series.value[0].end(), series.value[0][999]);
  std::vector<std::string> remarks;
  (void)mask_faults(series, remarks);
  EXPECT_EQ(n_missing(series.value[0]), 1001U);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks[0], HasSubstr("left: stuck at"));
  EXPECT_THAT(remarks[0], HasSubstr("from 49.95 s on"));
}

TEST(SeriesFaults, ARestOfAllChannelsIsNoFault) {
  ChannelSeries series = two_channels();
  for (auto& values : series.value) std::fill(values.begin(), values.begin() + 400, 0.0);
  std::vector<std::string> remarks;
  (void)mask_faults(series, remarks);
  EXPECT_EQ(n_missing(series.value[0]) + n_missing(series.value[1]), 0U) << remarks.front();
}

TEST(SeriesFaults, CoarseStepsAreNeitherStuckNorSaturated) {
  ChannelSeries series = two_channels();
  for (auto& values : series.value) {
    for (double& x : values) x = std::round(x / 2.0) * 2.0;  // a few levels
  }
  std::vector<std::string> remarks;
  (void)mask_faults(series, remarks);
  EXPECT_THAT(remarks, IsEmpty());
}

TEST(SeriesFaults, SaturationIsNamedAndKept) {
  ChannelSeries series = two_channels();
  const double limit = 0.5 * *std::max_element(series.value[0].begin(), series.value[0].end());
  for (double& x : series.value[0]) x = std::min(x, limit);
  std::vector<std::string> remarks;
  (void)mask_faults(series, remarks);
  EXPECT_EQ(n_missing(series.value[0]), 0U);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks[0], HasSubstr("exactly its largest value"));
}

TEST(SeriesFaults, ASineIsNotSaturated) {
  ChannelSeries series = two_channels();
  for (std::size_t t = 0; t < series.value[0].size(); ++t)
    series.value[0][t] = std::round(1000.0 * std::sin(0.317 * static_cast<double>(t)));
  std::vector<std::string> remarks;
  (void)mask_faults(series, remarks);
  EXPECT_THAT(remarks, IsEmpty());
}

TEST(SeriesFaults, ASingleOutlierIsMaskedAndCounted) {
  ChannelSeries series = two_channels();
  series.value[1][500] += 60.0;
  std::vector<std::string> remarks;
  EXPECT_THAT(mask_faults(series, remarks), ElementsAre(0, 1));
  EXPECT_TRUE(std::isnan(series.value[1][500]));
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks[0], HasSubstr("right: 1 sample"));
}

}  // namespace
}  // namespace app
