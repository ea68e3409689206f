// Which part of the camera's motion is removed, and which a static region witnesses.
#include "core/geometry/camera_following.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/motion_contradiction.h"
#include "core/geometry/resting_region.h"
#include "core/geometry/slow_rotation.h"
#include "tests/support/plate_tracks.h"

namespace core {
namespace {

using test_support::Measured;
using test_support::PlateView;

double no_zoom(double) { return 1.0; }

// All plates move with the camera: 20 mm slowly, 1 mm at 6 Hz. Its shift is followed as a rotation, which fits within 1
// %.
double shaken_sway(std::size_t, double t) {
  return 20.0 * std::sin(2.0 * std::numbers::pi * 0.1 * t) + std::sin(2.0 * std::numbers::pi * 6.0 * t);
}

TEST(CameraFollowing, RemovesSlowCameraMotionAndLeavesTheFastToItsWitness) {
  const PlateView view;
  ChannelDisplacementConfig config = view.config();
  config.following = CameraFollowing::kSlow;
  config.regions[2].role = RegionRole::kGround;
  Measured measure(config, view.frame(0.0, shaken_sway, no_zoom));
  ASSERT_EQ(measure.channels.n_witnesses(), 2U);
  double largest_mm = 0.0;
  for (int k = 1; k < 500; ++k) {
    TrackFrame tracks = view.frame(k / view.rate_hz, shaken_sway, no_zoom);
    const DisplacementSample& sample = measure(tracks);
    ASSERT_EQ(sample.witness_seen[0], 1);
    EXPECT_NEAR(sample.value_mm[0], sample.witness_mm[0], 1.0) << k;
    largest_mm = std::max(largest_mm, std::abs(sample.value_mm[0]));
  }
  EXPECT_GT(largest_mm, 0.8);  // the vibration
  EXPECT_LT(largest_mm, 6.0);  // a fifth of the slow motion, which causal filters leave, and the vibration
}

TEST(CameraFollowing, WithoutAWitnessTheDistanceAloneIsRemoved) {
  const PlateView view;
  ChannelDisplacementConfig config = view.config();
  config.witness = false;
  config.regions[2].role = RegionRole::kGround;
  const TrackFrame keyframe = view.frame(0.0, shaken_sway, no_zoom);
  config.following = CameraFollowing::kDistance;
  Measured distance(config, keyframe);
  config.following = CameraFollowing::kSlow;
  Measured slow(config, keyframe);
  for (int k = 1; k < 50; ++k) {
    TrackFrame tracks = view.frame(k / view.rate_hz, shaken_sway, no_zoom);
    EXPECT_EQ(slow(tracks).value_mm, distance(tracks).value_mm) << k;
  }
}

// Whether the whole camera motion is given up within a minute in which all plates move by `moved_mm`.
template <class Moved>
bool gives_up(const Moved& moved_mm) {
  PlateView view;
  view.readout_s = 0.04;
  ChannelDisplacementConfig config = view.config();
  config.following = CameraFollowing::kWhole;
  config.regions[2].role = RegionRole::kGround;
  Measured measure(config, view.frame(0.0, moved_mm, no_zoom));
  for (int k = 1; k < 1500; ++k) {
    TrackFrame tracks = view.frame(k / view.rate_hz, moved_mm, no_zoom);
    (void)measure(tracks);
  }
  return measure.channels.camera_given_up();
}

TEST(CameraFollowing, GivesUpAVibrationThatItsMotionDoesNotFollow) {
  const auto drift = [](std::size_t, double t) { return 20.0 * std::sin(2.0 * std::numbers::pi * 0.1 * t); };
  const auto vibration = [](std::size_t, double t) { return 4.0 * std::sin(2.0 * std::numbers::pi * 8.0 * t); };
  EXPECT_FALSE(gives_up(drift));
  EXPECT_TRUE(gives_up(vibration));
}

TEST(MotionContradiction, LastsWhereAStaticRegionIsOftenLeftMoving) {
  MotionContradiction often, seldom, in_a_row;
  for (int k = 0; k < 2000; ++k) {
    often.add(false, k % 10 == 0 ? 3.0 : 0.2);
    seldom.add(false, k % 50 == 0 ? 3.0 : 0.9);
    in_a_row.add(k < 50, 0.0);
  }
  EXPECT_TRUE(often.lasts());
  EXPECT_FALSE(seldom.lasts());
  EXPECT_FALSE(in_a_row.lasts()) << "fifty frames";
  for (int k = 0; k < 51; ++k) in_a_row.add(true, 0.0);
  EXPECT_TRUE(in_a_row.lasts());
  in_a_row.add(false, 0.0);
  EXPECT_TRUE(in_a_row.lasts()) << "for good";
}

// The camera turns by 5 degrees and stays there: a point is seen where it was, to a hundredth of a pixel.
TEST(SlowRotation, EndsAtTheRotationThatAStaticRegionShows) {
  constexpr double kFocal_px = 1000.0;
  const std::vector<Vector2> region{{-320.0, 150.0}, {-180.0, 150.0}, {-320.0, 250.0}, {-180.0, 250.0}};
  const Eigen::Vector3d axis = Eigen::Vector3d(0.6, -0.7, 0.4).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(5.0 * std::numbers::pi / 180.0, axis).toRotationMatrix();
  const auto seen = [&](const Vector2& p) {
    const Eigen::Vector3d ray = turn * Eigen::Vector3d(p.u / kFocal_px, p.v / kFocal_px, 1.0);
    return Vector2{kFocal_px * ray.x() / ray.z(), kFocal_px * ray.y() / ray.z()};
  };
  SlowRotation rotation(kFocal_px, kFocal_px, {-250.0, 200.0});
  std::vector<Vector2> motion(region.size());
  std::vector<std::uint8_t> is_seen(region.size(), 1), is_inlier(region.size(), 1);
  for (int k = 0; k < 200; ++k) {
    std::vector<Vector2> now;
    now.reserve(region.size());
    for (const Vector2& p : region) now.push_back(rotation.undone(seen(p), p));
    const double turn_rad = follow_resting_region({now, region, is_seen}, 0.3, motion, is_inlier);
    RestingMotion left{{0.0, 0.0}, turn_rad};
    for (const Vector2& m : motion) left.moved_px.u += m.u / 4.0, left.moved_px.v += m.v / 4.0;
    rotation.add(left, 0.04);
  }
  EXPECT_NEAR((rotation.rotation_rad() - 5.0 * std::numbers::pi / 180.0 * axis).norm(), 0.0, 1e-5);
  const Vector2 corner = rotation.undone(seen({600.0, -400.0}), {600.0, -400.0});
  EXPECT_NEAR(corner.u, 600.0, 0.01);
  EXPECT_NEAR(corner.v, -400.0, 0.01);
}

}  // namespace
}  // namespace core
