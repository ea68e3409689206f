#include "core/spectrum/time_grid.h"

#include <gtest/gtest.h>

#include <limits>

namespace core {
namespace {

constexpr std::int64_t kFrame_ns = 40'000'000;  // 25 per second
constexpr std::int64_t kStart_ns = 1'234'567'890'123;

struct Grid : TimeGrid {
  Grid() : TimeGrid(25.0) {}
  // Time stamp `frames` frames after the first one.
  Placement at(double frames) {
    return place(kStart_ns + static_cast<std::int64_t>(frames * static_cast<double>(kFrame_ns)));
  }
};

TEST(TimeGrid, CountsFromTheFirstSample) {
  Grid grid;
  for (int i = 0; i < 100; ++i) {
    const TimeGrid::Placement placement = grid.at(i);
    EXPECT_TRUE(placement.accepted);
    EXPECT_EQ(placement.cell, static_cast<std::uint64_t>(i));
    EXPECT_EQ(placement.n_missing_before, 0U);
  }
  EXPECT_EQ(grid.n_refused(), 0U);
}

TEST(TimeGrid, CountsTheCellsOfAGap) {
  Grid grid;
  (void)grid.at(0);
  const TimeGrid::Placement after = grid.at(4);
  EXPECT_TRUE(after.accepted);
  EXPECT_EQ(after.cell, 4U);
  EXPECT_EQ(after.n_missing_before, 3U);
  EXPECT_EQ(grid.at(5).n_missing_before, 0U);
}

TEST(TimeGrid, RefusesRepeatedAndBackwardStamps) {
  Grid grid;
  (void)grid.at(0);
  (void)grid.at(1);
  EXPECT_FALSE(grid.at(1).accepted);
  EXPECT_FALSE(grid.at(0).accepted);
  EXPECT_FALSE(grid.at(-7).accepted);
  EXPECT_EQ(grid.n_refused(), 3U);
  EXPECT_EQ(grid.at(2).cell, 2U) << "what was refused leaves no trace";
}

TEST(TimeGrid, KeepsTheOrderUnderJitterAndStatesIt) {
  Grid grid;
  const double jitter[] = {0.0, 0.3, -0.3, 0.2, -0.4, 0.1};
  for (int i = 0; i < 6; ++i) {
    const TimeGrid::Placement placement = grid.at(i + jitter[i]);
    EXPECT_EQ(placement.cell, static_cast<std::uint64_t>(i));
    EXPECT_EQ(placement.n_missing_before, 0U);
  }
  EXPECT_NEAR(grid.worst_jitter_cells(), 0.4, 1e-6);
}

// 29.97 frames a second for a week: the cell number must not drift by rounding.
TEST(TimeGrid, DoesNotDriftOverALongRecord) {
  TimeGrid grid(30000.0 / 1001.0);
  (void)grid.place(kStart_ns);
  const std::int64_t n = 604'800LL * 30;
  EXPECT_EQ(grid.place(kStart_ns + n * 1'001'000'000 / 30).cell, static_cast<std::uint64_t>(n));
}

TEST(TimeGrid, SurvivesStampsFromTheEndsOfTime) {
  constexpr auto kLow = std::numeric_limits<std::int64_t>::min();
  constexpr auto kHigh = std::numeric_limits<std::int64_t>::max();
  TimeGrid rising(25.0);
  (void)rising.place(kLow);
  EXPECT_TRUE(rising.place(kHigh).accepted);
  TimeGrid falling(25.0);
  (void)falling.place(kHigh);
  EXPECT_FALSE(falling.place(kLow).accepted);
}

}  // namespace
}  // namespace core
