#include "tools/validate/drawn_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/simulation/track_generator.h"

namespace tools {
namespace {

TEST(DrawnScene, IsAFunctionOfItsSeedAlone) {
  const DrawnScene a = draw_scene(7, 30.0), same = draw_scene(7, 60.0), other = draw_scene(8, 30.0);
  EXPECT_EQ(a.words, same.words) << "whatever the length of the record";
  EXPECT_EQ(a.scene.structure.stiffness, same.scene.structure.stiffness);
  EXPECT_NE(a.words, other.words);
  EXPECT_NE(a.scene.camera.alpha_px, other.scene.camera.alpha_px);
  EXPECT_NE(a.scene.tracks.noise_px, other.scene.tracks.noise_px);
}

TEST(DrawnScene, StaysWithinItsRangesAndReachesMostOfThem) {
  std::set<int> storeys;
  double slowest = 1e9, fastest = 0.0, quietest = 1e9, noisiest = 0.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const core::simulation::Scene scene = draw_scene(seed, 10.0).scene;  // validated: the drift leaves it in the image
    storeys.insert(scene.structure.n_bodies());
    const double first_hz = modes_of(scene.structure).front().frequency_hz;
    EXPECT_GE(first_hz, 0.999);
    EXPECT_LE(first_hz, 2.001);
    EXPECT_GE(scene.camera.readout_s, 0.008);
    EXPECT_LE(scene.camera.readout_s * scene.camera.rate_hz, 0.95 + 1e-12);
    slowest = std::min(slowest, scene.camera.rate_hz), fastest = std::max(fastest, scene.camera.rate_hz);
    quietest = std::min(quietest, scene.tracks.noise_px), noisiest = std::max(noisiest, scene.tracks.noise_px);
  }
  EXPECT_EQ(storeys, (std::set<int>{4, 5, 6, 7, 8}));
  EXPECT_GE(slowest, 24.0);
  EXPECT_LT(slowest, 26.0);
  EXPECT_LE(fastest, 60.0);
  EXPECT_GT(fastest, 56.0);
  EXPECT_GE(quietest, 0.01);
  EXPECT_LT(quietest, 0.012);
  EXPECT_LE(noisiest, 0.1);
  EXPECT_GT(noisiest, 0.08);
}

TEST(DrawnScene, StatesNoPointsNoiseAsItIs) {
  core::simulation::Scene scene = draw_scene(3, 10.0).scene;
  scene.tracks.points_per_region = 10;
  const core::simulation::TrackGenerator tracks(scene);
  double least = 1e9, most = 0.0;
  for (const auto& point : tracks.points()) {
    EXPECT_NE(point.stated_px, point.noise_px);
    EXPECT_NEAR(std::log(point.stated_px / point.noise_px), 0.0, 0.7);
    least = std::min(least, point.noise_px), most = std::max(most, point.noise_px);
  }
  EXPECT_GT(most / least, 2.0) << "unequal over the points";
}

}  // namespace
}  // namespace tools
