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
  const std::vector<double> at_once(region.size(), 0.0);
  const Eigen::Vector3d axis = Eigen::Vector3d(0.6, -0.7, 0.4).normalized();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(5.0 * std::numbers::pi / 180.0, axis).toRotationMatrix();
  const auto seen = [&](const Vector2& p) {
    const Eigen::Vector3d ray = turn * Eigen::Vector3d(p.u / kFocal_px, p.v / kFocal_px, 1.0);
    return Vector2{kFocal_px * ray.x() / ray.z(), kFocal_px * ray.y() / ray.z()};
  };
  SlowRotation rotation(kFocal_px, kFocal_px);
  std::vector<Vector2> motion(region.size());
  std::vector<std::uint8_t> is_seen(region.size(), 1), is_inlier(region.size(), 1);
  for (int k = 0; k < 200; ++k) {
    std::vector<Vector2> now, turned;
    for (const Vector2& p : region) {
      turned.push_back(rotation.turned(p, 0.0));
      now.push_back({seen(p).u + p.u - turned.back().u, seen(p).v + p.v - turned.back().v});
    }
    const RestingPoints points{now, region, turned, is_seen, at_once};
    const double turn_rad = follow_resting_region(points, 0.3, motion, is_inlier);
    RestingMotion left{{0.0, 0.0}, turn_rad};
    for (const Vector2& m : motion) left.moved_px.u += m.u / 4.0, left.moved_px.v += m.v / 4.0;
    rotation.add(left, shown_rotation(points, is_inlier, kFocal_px, kFocal_px), 0.04);
  }
  EXPECT_NEAR((rotation.rotation_rad() - 5.0 * std::numbers::pi / 180.0 * axis).norm(), 0.0, 1e-5);
  const Vector2 corner = rotation.turned({600.0, -400.0}, 0.03), truth = seen({600.0, -400.0});
  EXPECT_NEAR(corner.u, truth.u, 0.01);
  EXPECT_NEAR(corner.v, truth.v, 0.01);
}

// A camera that turns at a constant rate: what is removed from a row read later is what the camera has turned by then.
TEST(SlowRotation, GoesOnUntilTheRowIsRead) {
  constexpr double kFocal_px = 1000.0, kRate_rad_s = 0.001, kLate_s = 0.03, kFrame_s = 0.04;
  const std::vector<Vector2> region{{-50.0, -50.0}, {50.0, -50.0}, {-50.0, 50.0}, {50.0, 50.0}};
  const std::vector<double> share{0.45, 0.45, 0.55, 0.55};
  const std::vector<std::uint8_t> counts(region.size(), 1);
  const Eigen::Matrix3d shown = shown_rotation({region, region, region, counts, share}, counts, kFocal_px, kFocal_px);
  SlowRotation rotation(kFocal_px, kFocal_px);
  const Vector2 point{100.0, 300.0};
  for (int k = 0; k < 50; ++k) {
    const double whole_px = kFocal_px * kRate_rad_s * kFrame_s * k;
    rotation.add({{whole_px - kFocal_px * rotation.rotation_rad().y(), 0.0}, 0.0}, shown, kFrame_s);
  }
  EXPECT_NEAR(rotation.turned(point, kLate_s).u - rotation.turned(point, 0.0).u,
              kFocal_px * kRate_rad_s * kLate_s * (1.0 + 0.1 * 0.1), 0.001);
}

TEST(SlowRotation, IgnoresPointsThatDoNotDetermineIt) {
  constexpr double kFocal_px = 1000.0;
  SlowRotation rotation(kFocal_px, kFocal_px);
  const std::vector<Vector2> one_place(4, {100.0, 50.0});
  const std::vector<double> share(one_place.size(), 0.5);
  const std::vector<std::uint8_t> counts(one_place.size(), 1);
  const RestingPoints points{one_place, one_place, one_place, counts, share};
  rotation.add({{3.0, 1.0}, 0.0}, shown_rotation(points, counts, kFocal_px, kFocal_px), 0.04);
  EXPECT_EQ(rotation.rotation_rad().norm(), 0.0);
  EXPECT_EQ(rotation.turned({100.0, 50.0}, 0.01).u, 100.0);
}

struct Sheared {
  double turn_rad = 0.0, grown = 0.0;
};

// A region of the given size, turned and then sheared: the camera moves by `during_px` while the rows are read.
Sheared follow_sheared(const Vector2& size_px, double turn_rad, const Vector2& during_px) {
  std::vector<Vector2> keyframe, now;
  std::vector<double> share;
  for (int k = 0; k < 40; ++k) {
    const double x = std::fmod(0.37 * k, 1.0) - 0.5, y = std::fmod(0.61 * k, 1.0) - 0.5;
    const Vector2 p{size_px.u * x + 50.0, size_px.v * y - 20.0};
    keyframe.push_back(p);
    share.push_back((p.v + 540.0) / 1080.0);
    now.push_back(
        {p.u - turn_rad * p.v + during_px.u * share.back(), p.v + turn_rad * p.u + during_px.v * share.back()});
  }
  std::vector<Vector2> motion(keyframe.size());
  const std::vector<std::uint8_t> is_seen(keyframe.size(), 1);
  std::vector<std::uint8_t> is_inlier(keyframe.size(), 1);
  Sheared out;
  out.turn_rad = follow_resting_region({now, keyframe, keyframe, is_seen, share}, 0.3, motion, is_inlier);
  for (std::size_t i = 0; i < motion.size(); ++i) out.grown = std::max(out.grown, std::abs(motion[i].u - motion[0].u));
  return out;
}

TEST(RestingRegion, ACameraThatMovesWhileRowsAreReadIsNoRotation) {
  const Sheared moved = follow_sheared({600.0, 400.0}, 0.0, {1.0, 0.5});
  EXPECT_NEAR(moved.turn_rad, 0.0, 1e-9);
  EXPECT_LT(moved.grown, 0.4) << "the shear itself, 1 px over the height of the image, remains";
  EXPECT_NEAR(follow_sheared({600.0, 400.0}, 1e-3, {1.0, 0.5}).turn_rad, 1e-3, 1e-8);
}

TEST(RestingRegion, AColumnOfPointsIsTurnedAsAWhole) {
  EXPECT_NEAR(follow_sheared({20.0, 800.0}, 1e-3, {0.0, 0.0}).turn_rad, 1e-3, 1e-8);
  EXPECT_NEAR(follow_sheared({20.0, 800.0}, 0.0, {1.08, 0.0}).turn_rad, -1e-3, 1e-5);
}

}  // namespace
}  // namespace core
