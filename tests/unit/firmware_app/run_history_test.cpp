#include "firmware_app/report/run_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(BinnedSeries, AShortSeriesIsKeptAsItIs) {
  BinnedSeries series;
  for (const auto& [cell, value] : {std::pair{0U, 1.0}, {1U, 2.0}, {2U, kNan}, {3U, 0.5}}) series.add(cell, value);
  const std::vector<PlotPoint> curve = series.curve(0.04);
  ASSERT_EQ(curve.size(), 4U);
  EXPECT_EQ(curve[1].x, 0.04);
  EXPECT_EQ(curve[1].y, 2.0);
  EXPECT_TRUE(std::isnan(curve[2].y));
  EXPECT_EQ(series.n_values(), 3U);
  EXPECT_NEAR(series.mean(), 3.5 / 3.0, 1e-15);
}

TEST(BinnedSeries, ALongSeriesKeepsItsExtremesTheirTimesAndItsGaps) {
  BinnedSeries series;
  for (std::uint64_t i = 0; i < 1'000'000; ++i) {
    if (i >= 400'000 && i < 500'000) continue;
    series.add(i, i == 777'777 ? 50.0 : i == 888'888 ? -60.0 : std::sin(1e-4 * static_cast<double>(i)));
  }
  const std::vector<PlotPoint> curve = series.curve(1.0);
  EXPECT_LE(curve.size(), 2 * BinnedSeries::kBins);
  EXPECT_GE(curve.size(), BinnedSeries::kBins / 2);
  const auto has = [&](double x, double y) {
    return std::any_of(curve.begin(), curve.end(), [&](const PlotPoint& p) { return p.x == x && p.y == y; });
  };
  EXPECT_TRUE(has(777'777.0, 50.0));
  EXPECT_TRUE(has(888'888.0, -60.0));
  EXPECT_TRUE(std::any_of(curve.begin(), curve.end(),
                          [](const PlotPoint& p) { return std::isnan(p.y) && p.x > 400'000.0 && p.x < 500'000.0; }));
  EXPECT_TRUE(std::is_sorted(curve.begin(), curve.end(), [](const auto& a, const auto& b) { return a.x < b.x; }));
  EXPECT_EQ(series.low(), -60.0);
  EXPECT_EQ(series.high(), 50.0);
  EXPECT_EQ(series.n_values(), 900'000U);
}

TEST(BinnedSeries, SurvivesATimeFarAway) {
  BinnedSeries series;
  series.add(0, 1.0);
  series.add(std::numeric_limits<std::uint64_t>::max() / 2, 2.0);
  EXPECT_LE(series.curve(1.0).size(), 2 * BinnedSeries::kBins);
  EXPECT_EQ(series.high(), 2.0);
}

TEST(RunHistory, CountsPointsAndSigmaOfEveryRegion) {
  RunHistory history(25.0, 1, 2);
  core::TrackFrame frame;
  for (std::uint32_t i = 0; i < 8; ++i)
    frame.points.push_back({0.0, 0.0, 0.03, i, static_cast<std::uint16_t>(i / 4), i != 0, true});
  frame.points.push_back({0.0, 0.0, 0.1, 9, 77, true, true});  // of a region that does not exist
  history.add(frame);
  EXPECT_EQ(history.regions()[0].n_points, 4U);
  EXPECT_EQ(history.regions()[0].share_seen.mean(), 0.75);
  EXPECT_EQ(history.regions()[1].share_seen.mean(), 1.0);
  EXPECT_NEAR(history.regions()[1].sigma_px.mean(), 0.03, 1e-12);
}

core::ModalEstimate estimate_of(std::uint64_t n_samples, const std::vector<std::uint32_t>& ids) {
  core::ModalEstimate estimate;
  estimate.n_samples = n_samples;
  for (const std::uint32_t id : ids) {
    core::Mode mode;
    mode.frequency_hz = id, mode.damping_ratio = 0.01 * id;
    if (id != 0)
      mode.history = core::ModeHistory{.id = id, .drift_hz_per_s = {}, .drift_std_hz_per_s = {}, .more_s = {}};
    estimate.modes.push_back(mode);
  }
  return estimate;
}

TEST(RunHistory, FollowsModesByTheirNumbers) {
  RunHistory history(25.0, 1, 0);
  history.add(estimate_of(500, {0, 0}));
  history.add(estimate_of(750, {1, 2}));
  history.add(estimate_of(1000, {2}));
  EXPECT_EQ(history.n_estimates(), 3U);
  ASSERT_NE(history.followed(2), nullptr);
  EXPECT_EQ(history.followed(1)->frequency_hz.n_values(), 1U);
  EXPECT_EQ(history.followed(2)->frequency_hz.n_values(), 2U);
  EXPECT_EQ(history.followed(2)->damping_ratio.mean(), 0.02);
  EXPECT_EQ(history.followed(3), nullptr);
  EXPECT_EQ(history.followed(0), nullptr);
  for (std::uint32_t id = 3; id < 40; ++id) history.add(estimate_of(1250, {id}));
  EXPECT_NE(history.followed(RunHistory::kMaxFollowed), nullptr);
  EXPECT_EQ(history.followed(RunHistory::kMaxFollowed + 1), nullptr);
}

}  // namespace
}  // namespace app
