#include "core/geometry/motion_axes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace core {
namespace {

constexpr double kRate_hz = 25.0, kNoise_px = 0.02;
constexpr std::size_t kPoints = 10;  // a region

// Regions that move along `deg` with their own amplitudes, on top of a hover of many pixels that all share.
struct Scene {
  std::vector<Region> regions;
  std::vector<double> amplitude_px, deg;

  void add(RegionRole role, double amplitude, double axis_deg) {
    Region region;
    region.name = "r" + std::to_string(regions.size());
    region.role = role;
    region.axis_from = AxisFrom::kSought;
    regions.push_back(region);
    amplitude_px.push_back(amplitude), deg.push_back(axis_deg);
  }
  double zoom = 0.0;  // of the camera, rms about, at 0.4 Hz; regions stand above one another
  [[nodiscard]] MotionAxes seen_for(double seconds) const {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, kNoise_px);
    MotionAxes axes(regions, regions.size() * kPoints);
    TrackFrame frame;
    frame.points.resize(regions.size() * kPoints);
    for (int k = 0; k < static_cast<int>(seconds * kRate_hz); ++k) {
      const double t = k / kRate_hz;
      frame.t_start_ns = static_cast<std::int64_t>(1e9 * t);
      for (std::size_t i = 0; i < frame.points.size(); ++i) {
        const std::size_t r = i / kPoints;
        const bool is_far = regions[r].role == RegionRole::kBackground;
        const double own =
            amplitude_px[r] * std::sin(2.0 * std::numbers::pi * (std::abs(deg[r] - deg[0]) < 10.0 ? 3.1 : 4.3) * t);
        const double angle = deg[r] * std::numbers::pi / 180.0;
        TrackPoint& point = frame.points[i];
        const double nearer = 1.0 + zoom * std::sin(2.0 * std::numbers::pi * 0.4 * t);
        const double u0 = 8.0 * static_cast<double>(i % kPoints), v0 = 100.0 * static_cast<double>(r);
        point = {100.0 + own * std::cos(angle) + (is_far ? 0.5 : 1.0) * 20.0 * std::sin(0.9 * t) + noise(random),
                 50.0 + own * std::sin(angle) + (is_far ? 0.5 : 1.0) * 12.0 * std::cos(0.7 * t) + noise(random)};
        point.u_px += u0 * nearer, point.v_px += v0 * nearer;
        point.sigma_px = kNoise_px, point.region = static_cast<std::uint16_t>(r), point.seen = true;
      }
      axes.add(frame);
    }
    return axes;
  }
};

Scene tower(double deg) {
  Scene scene;
  scene.add(RegionRole::kBase, 0.0, deg);
  for (int storey = 1; storey <= 4; ++storey) scene.add(RegionRole::kStructure, 0.3 * storey, deg);
  scene.add(RegionRole::kBackground, 0.0, 0.0);
  return scene;
}

TEST(MotionAxes, FindsTheDirectionUnderAHoverOfManyPixels) {
  for (const double deg : {0.0, 8.0, 90.0, 84.0, 40.0, 130.0}) {
    const Scene scene = tower(deg);
    const auto choices = choose_axes(scene.seen_for(8.0), scene.regions);
    const double wanted = deg == 8.0 ? 0.0 : deg == 84.0 ? 90.0 : deg;
    for (std::size_t r = 0; r + 1 < scene.regions.size(); ++r) {
      EXPECT_EQ(choices[r].from, AxisFrom::kMotion) << deg;
      EXPECT_FALSE(choices[r].both_axes) << deg;
      EXPECT_NEAR(choices[r].axis_deg, wanted, 1e-9) << deg << ", region " << r;
    }
  }
}

TEST(MotionAxes, ACameraThatComesNearerIsNoMotionAlongTheTower) {
  Scene scene = tower(0.0);
  scene.zoom = 0.02;
  for (double& amplitude : scene.amplitude_px) amplitude *= 0.3;
  const auto choices = choose_axes(scene.seen_for(8.0), scene.regions);
  EXPECT_EQ(choices[4].axis_deg, 0.0);
  EXPECT_FALSE(choices[4].both_axes);
}

// A storey that moves as the middle of all does has nothing left along the axis but what it does across.
TEST(MotionAxes, TheStoreyAtTheMiddleKeepsTheCommonAxis) {
  Scene scene = tower(0.0);
  for (double& deg : scene.deg) deg = 7.0;
  for (int copy = 0; copy < 3; ++copy) scene.add(RegionRole::kStructure, 0.9, 14.0);
  for (double& amplitude : scene.amplitude_px) amplitude *= 10.0;
  const auto choices = choose_axes(scene.seen_for(8.0), scene.regions);
  for (std::size_t r = 0; r < choices.size(); ++r) EXPECT_EQ(choices[r].axis_deg, 0.0) << r;
}

TEST(MotionAxes, ARegionWithADirectionOfItsOwnKeepsIt) {
  Scene scene = tower(0.0);
  scene.add(RegionRole::kStructure, 1.5, 90.0);
  const auto choices = choose_axes(scene.seen_for(8.0), scene.regions);
  EXPECT_EQ(choices.back().axis_deg, 90.0);
  EXPECT_EQ(choices[4].axis_deg, 0.0);
}

TEST(MotionAxes, NothingThatMovesIsNoAxis) {
  Scene scene = tower(0.0);
  for (double& amplitude : scene.amplitude_px) amplitude = 0.0;
  const MotionAxes axes = scene.seen_for(8.0);
  EXPECT_FALSE(is_axis_clear(axes, scene.regions));
  for (const AxisChoice& choice : choose_axes(axes, scene.regions)) EXPECT_EQ(choice.from, AxisFrom::kNoMotion);
}

TEST(MotionAxes, StatesTheAmplitudesAlongAndAcross) {
  Scene scene;
  scene.add(RegionRole::kGround, 0.0, 0.0);
  scene.add(RegionRole::kStructure, 1.0, 90.0);
  const PlaneMotion motion = scene.seen_for(8.5).motion(1);
  EXPECT_NEAR(motion.across_px(0.0), std::sqrt(0.5), 0.02);
  EXPECT_NEAR(motion.along_px(0.0), 0.0, 0.02);
}

}  // namespace
}  // namespace core
