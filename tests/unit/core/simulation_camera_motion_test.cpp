#include "core/simulation/camera/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/simulation/presets.h"

namespace core::simulation {
namespace {

TEST(CameraMotion, Holds98PercentOfItsVarianceBelowHalfAHertz) {
  constexpr double kDuration_s = 200.0, kRate_hz = 10.0;
  double low = 0.0, all = 0.0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const CameraMotion hover(make_paper_scene(seed, kDuration_s));
    std::vector<double> x;
    for (int i = 0; i < static_cast<int>(kDuration_s * kRate_hz); ++i) {
      x.push_back(hover.at(i / kRate_hz).x_mm * std::sin(std::numbers::pi * i / (kDuration_s * kRate_hz)));
    }
    for (int k = 0; k < static_cast<int>(x.size()) / 2; ++k) {
      std::complex<double> sum = 0.0;
      const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * k / static_cast<double>(x.size()));
      std::complex<double> phase = 1.0;
      for (const double value : x) sum += value * phase, phase *= turn;
      all += std::norm(sum);
      if (k / kDuration_s < 0.5) low += std::norm(sum);
    }
  }
  EXPECT_NEAR(low / all, 0.98, 0.008);
}

TEST(CameraMotion, HasTheDeclaredSpreadOnEveryAxis) {
  double x = 0.0, y = 0.0, z = 0.0;
  constexpr int kSeeds = 20;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto rms = CameraMotion(make_paper_scene(seed, 100.0)).rms();
    x += rms[0] * rms[0], y += rms[1] * rms[1], z += rms[2] * rms[2];
    EXPECT_EQ(rms[3], 0.0);
  }
  EXPECT_NEAR(std::sqrt(x / kSeeds), 25.0, 2.0);
  EXPECT_NEAR(std::sqrt(y / kSeeds), 8.0, 0.7);
  EXPECT_NEAR(std::sqrt(z / kSeeds), 25.0, 2.0);
}

TEST(CameraMotion, KeepsTheOtherAxesWhenOneIsSwitchedOff) {
  const Scene scene = make_paper_scene(1, 30.0);
  Scene quiet = scene;
  quiet.hover.x_rms_mm = 0.0;
  quiet.hover.roll_rms_rad = 0.01;
  const CameraPose a = CameraMotion(scene).at(7.3), b = CameraMotion(quiet).at(7.3);
  EXPECT_EQ(b.x_mm, 0.0);
  EXPECT_EQ(a.y_mm, b.y_mm);
  EXPECT_EQ(a.z_mm, b.z_mm);
  EXPECT_TRUE(a.attitude.isIdentity());
  EXPECT_FALSE(b.attitude.isIdentity());
}

TEST(CameraMotion, DriftsAboutItsMeanPoseInItsOwnAxes) {
  Scene scene = make_paper_scene(1, 30.0);
  scene.hover = {};
  scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  scene.camera.x_mm = 100.0;
  scene.camera.roll_rad = 0.5 * std::numbers::pi;  // the camera's X axis is the world's Y axis
  const CameraMotion motion(scene);
  const double drift_mm = motion.deviation(3.0)[0];
  const CameraPose pose = motion.at(3.0);
  EXPECT_NE(drift_mm, 0.0);
  EXPECT_NEAR(pose.x_mm, 100.0, 1e-9);
  EXPECT_NEAR(pose.y_mm, drift_mm, 1e-9);
  EXPECT_FALSE(motion.rotates());
}

// The rotors' spectral line stays near its frequency, and its power is the declared one.
TEST(CameraMotion, VibratesAtTheRateOfTheRotors) {
  Scene scene = make_paper_scene(1, 60.0);
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  scene.rotor.pitch_rms_rad = 1e-4;
  const CameraMotion motion(scene);
  ASSERT_TRUE(motion.rotates());
  constexpr double kStep_s = 1e-4;
  int n_crossings = 0;
  double power = 0.0, before = motion.deviation(0.0)[3];
  for (int i = 1; i <= 300'000; ++i) {
    const double now = motion.deviation(i * kStep_s)[3];
    n_crossings += before < 0.0 && now >= 0.0 ? 1 : 0;
    power += now * now;
    before = now;
  }
  EXPECT_NEAR(n_crossings / 30.0, 95.0, 1.0);
  EXPECT_NEAR(std::sqrt(power / 300'000), 1e-4, 2e-6);
  EXPECT_EQ(motion.deviation(7.0)[4], 0.0);
}

}  // namespace
}  // namespace core::simulation
