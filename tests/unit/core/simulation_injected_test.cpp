#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "core/simulation/injected/gimbal_vibration.h"
#include "core/simulation/injected/shimmer.h"
#include "core/simulation/injected/tailed_hover.h"
#include "core/simulation/presets.h"
#include "core/simulation/render/renderer.h"
#include "core/simulation/scene_motion.h"

namespace core::simulation {
namespace {

// Mean power of x(t) at a frequency over pieces of 20 s under a sine-squared window.
template <class Signal>
double power_at(const Signal& x, double f_hz, double duration_s) {
  constexpr double kPiece_s = 20.0, kRate_hz = 100.0;
  double sum = 0.0;
  for (double from_s = 0.0; from_s + kPiece_s <= duration_s; from_s += kPiece_s) {
    std::complex<double> at = 0.0;
    for (int k = 0; k < static_cast<int>(kPiece_s * kRate_hz); ++k) {
      const double t_s = k / kRate_hz, window = std::pow(std::sin(std::numbers::pi * t_s / kPiece_s), 2);
      at += window * x(from_s + t_s) * std::polar(1.0, -2.0 * std::numbers::pi * f_hz * t_s);
    }
    sum += std::norm(at);
  }
  return sum;
}

Scene still_scene() {
  Scene scene = make_paper_scene(1, 30.0);
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  return scene;
}

TEST(TailedHover, FallsOffWithTheOrderOfEachAxisAndDoesNotEnd) {
  constexpr double kDuration_s = 100.0;
  TailedHoverParameters p;
  p.rms_mm = {10.0, 10.0, 10.0}, p.order = {3.0, 4.0, 5.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double low = 0.0, high = 0.0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const TailedHover hover(p, seed, kDuration_s);
      const auto x = [&](double t_s) { return hover.at(axis, t_s); };
      for (double off = -0.2; off < 0.25; off += 0.1)
        low += power_at(x, 4.0 + off, kDuration_s), high += power_at(x, 16.0 + 4.0 * off, kDuration_s);
    }
    EXPECT_NEAR(std::log(low / high) / std::log(4.0), p.order[axis], 0.2) << axis;
  }
}

TEST(TailedHover, HasTheDeclaredSpread) {
  TailedHoverParameters p;
  p.rms_mm = {7.0, 0.0, 0.0}, p.rms_rad = {0.0, 0.0, 0.01}, p.corner_hz[0] = p.turn_corner_hz[2] = 0.5;
  double x = 0.0, roll = 0.0, n = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const TailedHover hover(p, seed, 60.0);
    for (double t_s = 0.0; t_s < 60.0; t_s += 0.1, ++n)
      x += std::pow(hover.at(0, t_s), 2), roll += std::pow(hover.at(5, t_s), 2);
    EXPECT_EQ(hover.at(1, 3.0), 0.0);
  }
  EXPECT_NEAR(std::sqrt(x / n), 7.0, 0.7);
  EXPECT_NEAR(std::sqrt(roll / n), 0.01, 0.001);
}

TEST(GimbalVibration, FillsItsBandOnAllAxesTogether) {
  VibrationParameters p;
  p.centre_hz = 6.0, p.width_hz = 0.5, p.rms_rad = {1e-3, 1e-3, 2e-3};
  double inside = 0.0, outside = 0.0, product = 0.0, pitch = 0.0, roll = 0.0, n = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const GimbalVibration vibration(p, seed, 60.0);
    const auto x = [&](double t_s) { return vibration.at(5, t_s); };
    inside += power_at(x, 6.0, 60.0), outside += power_at(x, 9.0, 60.0);
    for (double t_s = 0.0; t_s < 60.0; t_s += 0.01, ++n)
      roll += std::pow(x(t_s), 2), pitch += std::pow(vibration.at(3, t_s), 2);
    // For any phase between the axes, the common half shows in the complex correlation.
    std::complex<double> cross = 0.0;
    for (double t_s = 1.0; t_s < 60.0; t_s += 0.01)
      cross += x(t_s) * std::complex<double>(vibration.at(3, t_s), vibration.at(3, t_s - 0.25 / p.centre_hz));
    product += std::abs(cross);
  }
  EXPECT_GT(inside, 1e4 * outside);
  EXPECT_NEAR(std::sqrt(roll / n), 2e-3, 2e-4);
  EXPECT_NEAR(product / std::sqrt(roll * pitch), 0.5, 0.12);
}

TEST(Shimmer, HasItsSpreadAndIsAGradient) {
  ShimmerParameters p;
  p.rms_px = 0.2;
  double u2 = 0.0, v2 = 0.0, curl2 = 0.0, divergence2 = 0.0, n = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Shimmer air(p, seed);
    for (double t_s = 0.0; t_s < 40.0; t_s += 4.0, ++n) {
      const auto here = air.at(300.0, 200.0, t_s), right = air.at(301.0, 200.0, t_s), below = air.at(300.0, 201.0, t_s);
      u2 += here.u_px * here.u_px, v2 += here.v_px * here.v_px;
      curl2 += std::pow((right.v_px - here.v_px) - (below.u_px - here.u_px), 2);
      divergence2 += std::pow((right.u_px - here.u_px) + (below.v_px - here.v_px), 2);
    }
  }
  EXPECT_NEAR(std::sqrt(u2 / n), 0.2, 0.03);
  EXPECT_NEAR(std::sqrt(v2 / n), 0.2, 0.03);
  EXPECT_LT(curl2, 1e-3 * divergence2);
}

TEST(Shimmer, MovesNearbyPointsAlikeAndFarOnesNot) {
  ShimmerParameters p;
  p.rms_px = 0.2, p.outer_px = 300.0, p.inner_px = 60.0;
  double near = 0.0, far = 0.0, own = 0.0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Shimmer air(p, seed);
    const double here = air.at(500.0, 500.0, 0.0).u_px;
    own += here * here, near += here * air.at(510.0, 500.0, 0.0).u_px, far += here * air.at(1500.0, 900.0, 0.0).u_px;
  }
  EXPECT_GT(near / own, 0.8);
  EXPECT_LT(std::abs(far / own), 0.25);
}

TEST(OwnMotion, MovesOnlyItsPartOfThePlate) {
  Scene scene = still_scene();
  const SceneMotion still(scene);
  scene.flap.rms_mm = 2.0, scene.flap.body = 3, scene.flap.from_share = 0.5;
  const SceneMotion motion(scene);
  const auto moved = [&](int body, double x_mm) {
    return motion.see(body, {x_mm, 0.0}, 7.0).u_px - still.see(body, {x_mm, 0.0}, 7.0).u_px;
  };
  EXPECT_EQ(moved(3, -10.0), 0.0);
  EXPECT_EQ(moved(2, 10.0), 0.0);
  EXPECT_NEAR(moved(3, 10.0), moved(3, 100.0), 1e-3);
  EXPECT_GT(std::abs(moved(3, 10.0)), 0.01);
}

TEST(OwnMotion, RocksAboutTheMiddleOfTheBase) {
  Scene scene = still_scene();
  scene.excitation.base = 0.0, scene.excitation.rms_mm = 0.0;
  scene.rocking.rms_rad = 0.005;
  const SceneMotion motion(scene);
  EXPECT_NEAR(motion.body_at(0, 4.0).x_mm, 0.0, 1e-12);
  const double height_mm = scene.plates[0].y_mm - scene.plates[6].y_mm, turn = motion.own().rocking_rad(4.0);
  ASSERT_NE(turn, 0.0);
  EXPECT_NEAR(motion.body_at(6, 4.0).x_mm, height_mm * std::sin(turn), 1e-9);
  EXPECT_NEAR(motion.body_at(6, 4.0).tilt_rad, turn, 1e-12);
}

TEST(Stabiliser, HoldsTheImageStillWithAGlobalShutter) {
  Scene scene = still_scene();
  scene.excitation.base = 0.0, scene.excitation.rms_mm = 0.0;
  scene.camera.readout_s = 0.0;
  scene.rotor = {3.0, 0.0, 0.1, 1e-4, 1e-4, 1e-3};
  scene.stabiliser = {1.0, 0.02, 0.0};
  const SceneMotion steady(scene);
  scene.stabiliser.gain = 0.0;
  const SceneMotion shaky(scene);
  const auto spread = [](const SceneMotion& motion) {
    double sum = 0.0, squares = 0.0, n = 0.0;
    for (double t_s = 0.0; t_s < 20.0; t_s += 0.04, ++n) {
      const double u_px = motion.see(5, {40.0, 0.0}, t_s).u_px;
      sum += u_px, squares += u_px * u_px;
    }
    return std::sqrt(squares / n - sum / n * sum / n);
  };
  EXPECT_LT(spread(steady), 0.03 * spread(shaky));
}

TEST(Renderer, DrawsTheLoosePartWhereItIs) {
  Scene scene = still_scene();
  set_image_size(scene, 480, 270);
  scene.excitation.base = 0.0, scene.excitation.rms_mm = 0.0;
  scene.camera.exposure_s = scene.camera.readout_s = scene.camera.noise_sigma = 0.0;
  const auto light_of = [](const Scene& which) {
    std::vector<float> light(480UL * 270UL);
    Renderer(which, Renderer::Way::kGeneral).render_light(std::uint64_t{100}, light.data());
    return light;
  };
  const std::vector<float> still = light_of(scene);
  scene.flap.rms_mm = 8.0, scene.flap.body = 3, scene.flap.from_share = 0.5;
  const std::vector<float> flapping = light_of(scene);
  Scene moved = scene;
  moved.flap.rms_mm = 0.0;
  moved.plates[3].x_mm += SceneMotion(scene).own().flap_mm(4.0);  // of frame 100
  const std::vector<float> all_moved = light_of(moved);
  ASSERT_NE(moved.plates[3].x_mm, scene.plates[3].x_mm);
  const auto row =
      static_cast<std::size_t>(std::lround(scene.camera.cy_px + scene.plates[3].y_mm / 2000.0 * scene.camera.alpha_px));
  const auto middle = static_cast<std::size_t>(scene.camera.cx_px);
  double left = 0.0, right = 0.0, change = 0.0;
  for (std::size_t u = 15; u < 30; ++u) {  // clear of the seam and of the rims
    const std::size_t before = 480 * row + middle - u, behind = 480 * row + middle + u;
    left = std::max(left, std::abs(static_cast<double>(flapping[before] - still[before])));
    right = std::max(right, std::abs(static_cast<double>(flapping[behind] - all_moved[behind])));
    change = std::max(change, std::abs(static_cast<double>(all_moved[behind] - still[behind])));
  }
  EXPECT_LT(left, 1e-3);
  EXPECT_LT(right, 1e-3);
  EXPECT_GT(change, 5.0);
}

TEST(Renderer, RefusesWhatPicturesDoNotShow) {
  const auto refuses = [](auto change) {
    Scene scene = still_scene();
    change(scene);
    EXPECT_THROW(Renderer{scene}, std::invalid_argument);
  };
  refuses([](Scene& s) { s.torsion.rms_rad = 1e-3; });
  refuses([](Scene& s) { s.shimmer.rms_px = 0.1; });
  refuses([](Scene& s) { s.stabiliser.gain = 0.5; });
  refuses([](Scene& s) { s.breathing.rms = 1e-3; });
}

TEST(Scene, RefusesInjectedEffectsOutOfRange) {
  const auto refuses = [](auto change) {
    Scene scene = still_scene();
    change(scene);
    EXPECT_THROW(validate(scene), std::invalid_argument);
  };
  refuses([](Scene& s) { s.tailed_hover.order[1] = 1.0; });
  refuses([](Scene& s) { s.tailed_hover.rms_mm[2] = std::nan(""); });
  refuses([](Scene& s) { s.vibration.width_hz = 0.0; });
  refuses([](Scene& s) { s.flap.body = 7; });
  refuses([](Scene& s) { s.shimmer.outer_px = 0.5 * s.shimmer.inner_px; });
  refuses([](Scene& s) { s.sway.frequency_hz = 0.0; });
}

}  // namespace
}  // namespace core::simulation
