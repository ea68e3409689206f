#include "core/geometry/published_shutter.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace core {
namespace {

constexpr std::size_t kPoints = 6;  // two in each of three regions: floor, floor, base
const std::array<double, kPoints> kShare{0.1, 0.2, 0.4, 0.5, 0.8, 0.9};
const std::vector<PublishedShutter::Region> kRegions{{0, 2, false}, {2, 4, false}, {4, 6, true}};

// Observations for camera motion `camera(t)` and floor motion `structure(region, t)`; t in frames, readout one
// frame.
template <class Camera, class Structure>
std::vector<Vector2> seen(double t, Camera camera, Structure structure) {
  std::vector<Vector2> motion;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const double at = t + kShare[i];
    motion.push_back({camera(at) + structure(i / 2, at), 0.5 * camera(at)});
  }
  return motion;
}

double steady_camera(double t) { return 3.0 * t; }
double floors(std::size_t region, double t) {
  return region == 2 ? 0.0 : std::sin(0.7 * t + static_cast<double>(region));
}
const std::vector<std::uint8_t> kAll(kPoints, 1);

// Eq. 8 is exact if the camera's velocity is the same as from the last frame to this one.
TEST(PublishedShutter, MovesTheCameraToLineZeroAndLeavesTheStructureAtItsLine) {
  PublishedShutter shutter(ShutterVelocity::kCamera, kRegions, kPoints);
  for (std::uint64_t k = 0; k < 20; ++k) {
    const auto t = static_cast<double>(k);
    std::vector<Vector2> motion = seen(t, steady_camera, floors);
    shutter.correct(k, kShare, kAll, motion);
    for (std::size_t i = 0; k > 0 && i < kPoints; ++i) {
      EXPECT_NEAR(motion[i].u, steady_camera(t) + floors(i / 2, t + kShare[i]), 1e-12) << "point " << i;
      EXPECT_NEAR(motion[i].v, 0.5 * steady_camera(t), 1e-12) << "point " << i;
    }
  }
}

// The floor's own velocity shifts it to line 0 as a whole, but only if it is steady, too.
TEST(PublishedShutter, MovesEveryRegionToLineZeroByItsOwnVelocity) {
  const auto sliding = [](std::size_t region, double t) { return static_cast<double>(region) * t; };
  PublishedShutter shutter(ShutterVelocity::kRegion, kRegions, kPoints);
  for (std::uint64_t k = 0; k < 5; ++k) {
    const auto t = static_cast<double>(k);
    std::vector<Vector2> motion = seen(t, steady_camera, sliding);
    shutter.correct(k, kShare, kAll, motion);
    for (std::size_t i = 0; k > 0 && i < kPoints; ++i) {
      EXPECT_NEAR(motion[i].u, steady_camera(t) + sliding(i / 2, t), 1e-12) << "point " << i;
    }
  }
}

TEST(PublishedShutter, APointThatComesOrGoesDoesNotMoveTheCamera) {
  const auto apart = [](std::size_t, double) { return 0.0; };
  PublishedShutter shutter(ShutterVelocity::kCamera, kRegions, kPoints);
  std::vector<std::uint8_t> inlier = kAll;
  for (std::uint64_t k = 0; k < 9; ++k) {
    inlier[5] = k % 2 == 0;
    std::vector<Vector2> motion = seen(static_cast<double>(k), steady_camera, apart);
    motion[5].u += 100.0;
    shutter.correct(k, kShare, inlier, motion);
    if (k > 0) {
      EXPECT_NEAR(motion[0].u, steady_camera(static_cast<double>(k)), 1e-12) << k;
    }
  }
}

TEST(PublishedShutter, AVelocityIsPerFrameAlsoWhereFramesAreMissing) {
  for (const ShutterVelocity velocity : {ShutterVelocity::kCamera, ShutterVelocity::kRegion}) {
    const auto apart = [](std::size_t, double) { return 0.0; };
    PublishedShutter shutter(velocity, kRegions, kPoints);
    std::vector<Vector2> motion = seen(0.0, steady_camera, apart);
    shutter.correct(0, kShare, kAll, motion);
    motion = seen(4.0, steady_camera, apart);
    shutter.correct(4, kShare, kAll, motion);
    for (std::size_t i = 0; i < kPoints; ++i) EXPECT_NEAR(motion[i].u, steady_camera(4.0), 1e-12);
  }
}

TEST(PublishedShutter, LeavesAFrameAsItIsWhereNothingTellsTheVelocity) {
  PublishedShutter shutter(ShutterVelocity::kCamera, kRegions, kPoints);
  const std::vector<std::uint8_t> floors_only{1, 1, 1, 1, 0, 0};
  for (std::uint64_t k = 0; k < 3; ++k) {
    const std::vector<Vector2> before = seen(static_cast<double>(k), steady_camera, floors);
    std::vector<Vector2> after = before;
    shutter.correct(k, kShare, floors_only, after);
    for (std::size_t i = 0; i < kPoints; ++i) EXPECT_EQ(after[i].u, before[i].u);
  }
}

}  // namespace
}  // namespace core
