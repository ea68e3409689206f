#include "core/simulation/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/simulation/camera/projection.h"
#include "core/simulation/presets.h"
#include "core/simulation/scene_motion.h"

namespace core::simulation {
namespace {

TEST(Scene, IsThePapersExperimentByDefault) {
  const Scene scene = make_paper_scene(1, 60.0);
  EXPECT_NO_THROW(validate(scene));
  EXPECT_EQ(scene.n_frames(), 1500U);
  EXPECT_EQ(scene.n_bodies(), 7);
  const std::vector<double> stated_hz{1.657, 5.04, 8.14, 10.83, 12.93, 14.34};
  const std::vector<TrueMode> modes = modes_of(scene.structure);
  ASSERT_EQ(modes.size(), stated_hz.size());
  for (std::size_t r = 0; r < modes.size(); ++r) {
    EXPECT_NEAR(modes[r].frequency_hz, stated_hz[r], 1e-9);
    EXPECT_NEAR(modes[r].damping_ratio, 0.01, 1e-12);
  }
  const core::CameraInfo info = scene.camera_info();
  EXPECT_EQ(info.width_px, 1920);
  EXPECT_EQ(info.height_px, 1080);
  EXPECT_EQ(info.readout_ns, 26'000'000);
  EXPECT_EQ(info.exposure_ns, 4'000'000);
  EXPECT_EQ(info.frame_count, 1500U);
}

TEST(Scene, CountsFramesWithoutLosingOneToRounding) {
  EXPECT_EQ(make_paper_scene(1, 0.04).n_frames(), 1U);
  EXPECT_EQ(make_paper_scene(1, 0.28).n_frames(), 7U);
  EXPECT_EQ(make_paper_scene(1, 10.0).n_frames(), 250U);
}

class SceneSize : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(SceneSize, KeepsEveryPlateInTheImageFor3SigmaOfDrift) {
  Scene scene = make_paper_scene(1, 60.0);
  set_image_size(scene, GetParam().first, GetParam().second);
  ASSERT_NO_THROW(validate(scene));
  for (const int body : {0, 6}) {
    for (int signs = 0; signs < 32; ++signs) {
      const auto sign = [&](int bit) { return (signs >> bit & 1) != 0 ? 1.0 : -1.0; };
      const CameraPose pose{3 * 25.0 * sign(0), 3 * 8.0 * sign(1), 3 * 25.0 * sign(2), Eigen::Matrix3d::Identity()};
      const ImagePoint corner = project(scene.camera, pose, 150.0 * sign(3),
                                        scene.plates[static_cast<std::size_t>(body)].y_mm + 25.0 * sign(4), 2000.0);
      EXPECT_GT(corner.u_px, 0.0);
      EXPECT_LT(corner.u_px, scene.camera.width_px - 1);
      EXPECT_GT(corner.v_px, 0.0);
      EXPECT_LT(corner.v_px, scene.camera.height_px - 1);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Sizes, SceneSize,
                         testing::Values(std::pair{1920, 1080}, std::pair{480, 270}, std::pair{640, 480},
                                         std::pair{320, 180}, std::pair{3840, 2160}));

TEST(Scene, MarksRegionsInsidePlatesAndApart) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SceneMotion motion(make_paper_scene(seed, 30.0));
    const auto regions = tracking_regions(motion);
    ASSERT_EQ(regions.size(), 8U);
    EXPECT_EQ(regions.front().region.name, "floor1");
    EXPECT_EQ(regions[6].region.name, "base");
    EXPECT_EQ(regions[6].region.role, core::RegionRole::kBase);
    EXPECT_EQ(regions[7].region.role, core::RegionRole::kBackground);
    for (std::size_t i = 0; i < 7; ++i) {
      const core::Region& r = regions[i].region;
      for (const double u : {r.u_px, r.u_px + r.width_px}) {
        for (const double v : {r.v_px, r.v_px + r.height_px}) {
          const PlanePoint p = motion.material_point(regions[i].body, {u, v}, 0.0);
          EXPECT_LT(std::abs(p.x_mm), 150.0 - 10.0);
          EXPECT_LT(std::abs(p.y_mm), 25.0 - 10.0);
        }
      }
    }
    EXPECT_GT(regions[7].region.width_px, 300.0);
    EXPECT_LT(regions[7].region.u_px + regions[7].region.width_px, regions[0].region.u_px - 50.0);
  }
}

TEST(Scene, RefusesWhatCannotBeSimulated) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(Scene&)>> faults{
      [&](Scene& s) { s.duration_s = nan; },
      [](Scene& s) { s.duration_s = 0.0; },
      [](Scene& s) { s.duration_s = -1.0; },
      [](Scene& s) { s.duration_s = 0.01; },
      [](Scene& s) { s.duration_s = 1e9; },
      [&](Scene& s) { s.camera.rate_hz = nan; },
      [](Scene& s) { s.camera.width_px = 100; },
      [](Scene& s) { s.camera.exposure_s = 1.0; },
      [](Scene& s) { s.camera.noise_sigma = -1.0; },
      [](Scene& s) { s.camera.alpha_px = 4000.0; },  // the roof leaves the image
      [](Scene& s) { s.structure = {}; },
      [](Scene& s) { s.plates.pop_back(); },
      [&](Scene& s) { s.structure.damping(0, 0) = nan; },
      [](Scene& s) { s.structure.damping *= -1.0; },
      [](Scene& s) { s.structure.stiffness(2, 2) *= -1.0; },
      [](Scene& s) { s.structure.mass(1, 1) = 0.0; },
      [](Scene& s) { s.hover.y_rms_mm = 100.0; },
      [](Scene& s) { s.hover.z_rms_mm = 500.0; },
      [](Scene& s) { s.plates[1].y_mm = s.plates[2].y_mm; },  // one in the other
      [](Scene& s) { s.camera.z_mm = 1990.0; },               // the camera in the structure
      [](Scene& s) { s.camera.z_mm = 2500.0; },               // and behind it
      [](Scene& s) { s.plates[0].texture.contrast_rms = 0.0; },
      [](Scene& s) {
        s.excitation.harmonics.push_back({7, 3.0, 1.0});
      },
      [](Scene& s) { s.timing.jitter_rms_s = 0.02; },
      [](Scene& s) { s.tracks.points_per_region = 0; },
      [&](Scene& s) { s.tracks.noise_px = nan; },
      [](Scene& s) { s.tracks.noise_px = -0.1; },
      [](Scene& s) { s.tracks.noise_spread = -0.1; },
      [&](Scene& s) { s.tracks.sigma_error = nan; },
      [](Scene& s) { s.tracks.loss_probability = 1.5; },
      [](Scene& s) { s.background.depth_mm = 1000.0; },
      [](Scene& s) { s.plates[3].texture.pitch_mm = 0.0; }};
  for (std::size_t i = 0; i < faults.size(); ++i) {
    Scene scene = make_paper_scene(1, 60.0);
    faults[i](scene);
    EXPECT_THROW(validate(scene), std::invalid_argument) << "fault " << i;
  }
}

}  // namespace
}  // namespace core::simulation
