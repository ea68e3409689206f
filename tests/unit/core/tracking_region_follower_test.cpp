#include "core/tracking/region_follower.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace core {
namespace {

constexpr std::size_t kPerRegion = 4, kRegions = 3;

std::vector<Vector2> keyframe() {
  std::vector<Vector2> points;
  for (const double v : {100.0, 200.0, 300.0}) {
    for (const double u : {140.0, 150.0, 160.0, 170.0}) points.push_back({u, v});
  }
  return points;
}

std::vector<std::uint16_t> region_of_point() { return {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}; }

RegionFollower follower() { return {{320, 400, 3, 5, 0.5}, keyframe(), region_of_point(), kRegions}; }

// The camera has rotated, approached and drifted; region r sways by sway_px[r].
TrackFrame moved(double turn_rad, double magnification, double down_px, std::array<double, kRegions> sway_px) {
  TrackFrame frame;
  const auto points = keyframe();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double u = points[i].u - 160.0 + sway_px[i / kPerRegion], v = points[i].v - 200.0;
    TrackPoint point;
    point.u_px = 160.0 + magnification * (std::cos(turn_rad) * u - std::sin(turn_rad) * v);
    point.v_px = 200.0 + down_px + magnification * (std::sin(turn_rad) * u + std::cos(turn_rad) * v);
    point.region = static_cast<std::uint16_t>(i / kPerRegion);
    point.seen = point.inlier = true;
    frame.points.push_back(point);
  }
  return frame;
}

void hide(TrackFrame& frame, std::size_t region) {
  for (std::size_t i = region * kPerRegion; i < (region + 1) * kPerRegion; ++i) {
    frame.points[i].seen = frame.points[i].inlier = false;
    frame.points[i].u_px = frame.points[i].v_px = std::numeric_limits<double>::quiet_NaN();
  }
}

TEST(RegionFollower, ARegionThatIsNotMeasuredGoesWithTheOthers) {
  RegionFollower regions = follower();
  regions.update(moved(0.0, 1.0, 0.0, {3.0, 2.0, 0.0}));
  const TrackFrame whole = moved(0.05, 1.1, 12.0, {3.0, 2.0, 0.0});
  TrackFrame frame = whole;
  hide(frame, 0);
  regions.update(frame);
  EXPECT_EQ(regions.state(0), RegionState::kSearching);
  EXPECT_EQ(regions.state(1), RegionState::kMeasuring);
  EXPECT_EQ(regions.n_inliers(0), 0U);
  // The remaining error is the influence of the others' sway on the common motion: they sway by 2 px over 100.
  for (std::size_t i = 0; i < kPerRegion; ++i) {
    EXPECT_NEAR(regions.expected(i).u, whole.points[i].u_px, 4.0);
    EXPECT_NEAR(regions.expected(i).v, whole.points[i].v_px, 4.0);
  }
  for (std::size_t i = kPerRegion; i < 3 * kPerRegion; ++i) EXPECT_EQ(regions.expected(i).u, frame.points[i].u_px);
}

TEST(RegionFollower, APointOffItsRegionIsExpectedWithIt) {
  RegionFollower regions = follower();
  TrackFrame frame = moved(0.0, 1.0, 7.0, {0.0, 0.0, 0.0});
  frame.points[5].inlier = false;
  frame.points[5].v_px = 999.0;
  regions.update(frame);
  EXPECT_EQ(regions.state(1), RegionState::kMeasuring);
  EXPECT_NEAR(regions.expected(5).v, keyframe()[5].v + 7.0, 1e-9);
}

TEST(RegionFollower, ARegionOutsideTheImageIsLostAndMeasuredAgainWhenItIsBack) {
  RegionFollower regions = follower();
  regions.update(moved(0.0, 1.0, 0.0, {}));
  for (int k = 0; k < 8; ++k) {
    TrackFrame frame = moved(0.0, 1.0, -120.0, {});  // the upper region is at -20
    hide(frame, 0);
    regions.update(frame);
    EXPECT_EQ(regions.state(0), RegionState::kLost);
    EXPECT_NEAR(regions.expected(0).v, -20.0, 1e-9) << "it is still known where it is";
  }
  TrackFrame back = moved(0.0, 1.0, -60.0, {});
  hide(back, 0);
  regions.update(back);
  EXPECT_NEAR(regions.expected(0).v, 40.0, 1e-9);
  regions.update(moved(0.0, 1.0, -60.0, {}));
  EXPECT_EQ(regions.state(0), RegionState::kMeasuring);
}

TEST(RegionFollower, ASearchEndsAfterItsTime) {
  RegionFollower regions = follower();
  regions.update(moved(0.0, 1.0, 0.0, {}));
  TrackFrame frame = moved(0.0, 1.0, 0.0, {});
  hide(frame, 2);
  for (int k = 0; k < 5; ++k) {
    regions.update(frame);
    EXPECT_EQ(regions.state(2), RegionState::kSearching) << k;
  }
  regions.update(frame);
  EXPECT_EQ(regions.state(2), RegionState::kLost);
}

TEST(RegionFollower, NothingMeasuredKeepsTheLastPlaces) {
  RegionFollower regions = follower();
  const TrackFrame last = moved(0.02, 1.0, 9.0, {1.0, 0.0, 0.0});
  regions.update(last);
  TrackFrame black = last;
  for (std::size_t r = 0; r < kRegions; ++r) hide(black, r);
  for (int k = 0; k < 100; ++k) regions.update(black);
  for (std::size_t i = 0; i < last.points.size(); ++i) {
    EXPECT_NEAR(regions.expected(i).u, last.points[i].u_px, 0.2);
    EXPECT_NEAR(regions.expected(i).v, last.points[i].v_px, 0.2);
  }
  for (std::size_t r = 0; r < kRegions; ++r) EXPECT_EQ(regions.state(r), RegionState::kLost);
}

TEST(RegionFollower, SurvivesAnythingInItsTracks) {
  RegionFollower regions = follower();
  TrackFrame empty;
  regions.update(empty);
  TrackFrame wild = moved(0.0, 1.0, 0.0, {});
  for (TrackPoint& point : wild.points) point.u_px = std::numeric_limits<double>::infinity();
  regions.update(wild);
  TrackFrame one_place = moved(0.0, 1.0, 0.0, {});
  for (TrackPoint& point : one_place.points) point.u_px = point.v_px = 5.0;
  regions.update(one_place);
  for (std::size_t i = 0; i < keyframe().size(); ++i) {
    EXPECT_TRUE(std::isfinite(regions.expected(i).u) && std::isfinite(regions.expected(i).v));
  }
  EXPECT_THROW((RegionFollower{{320, 400}, keyframe(), {0, 0}, 1}), std::invalid_argument);
  EXPECT_THROW((RegionFollower{{320, 400}, keyframe(), region_of_point(), 2}), std::invalid_argument);
}

}  // namespace
}  // namespace core
