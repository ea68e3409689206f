#include "core/simulation/track_generator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/simulation/presets.h"

namespace core::simulation {
namespace {

DeliveredFrame even_frame(std::uint64_t number) {
  const double t_s = static_cast<double>(number) / 25.0;
  return {number, t_s, t_s, number, false};
}

TEST(TrackGenerator, SeesEachPointAtTheTimeOfItsRow) {
  Scene scene = make_paper_scene(1, 30.0);
  scene.camera.exposure_s = 0.0;
  const SceneMotion motion(scene);
  for (int body = 0; body < 7; ++body) {
    const ImagePoint image = motion.see(body, {20.0, 0.0}, 11.0);
    const double t_s = 11.0 + 0.026 * image.v_px / 1080.0;
    const ImagePoint again =
        project(scene.camera, motion.camera().at(t_s), 20.0 + motion.structure().displacement_mm(body, t_s),
                scene.plates[static_cast<std::size_t>(body)].y_mm, 2000.0);
    EXPECT_NEAR(image.u_px, again.u_px, 1e-7);
    EXPECT_NEAR(image.v_px, again.v_px, 1e-7);
  }
}

// A long exposure shows the mean of the motion: a sine of frequency f loses sinc(f T) of itself.
TEST(TrackGenerator, AveragesTheMotionOverTheExposure) {
  Scene scene = make_paper_scene(1, 30.0);
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  scene.excitation.rms_mm = 0.0;
  scene.excitation.harmonics = {{6, 8.14, 2.0}};
  scene.camera.readout_s = 0.0;
  scene.camera.exposure_s = 0.02;
  const SceneMotion motion(scene);
  const double loss = std::sin(std::numbers::pi * 8.14 * 0.02) / (std::numbers::pi * 8.14 * 0.02);
  for (int k = 0; k < 50; ++k) {
    const double t_s = 0.31 * k;
    const double seen_mm = (motion.see(6, {}, t_s).u_px - scene.camera.cx_px) * 2000.0 / 2100.0;
    EXPECT_NEAR(seen_mm, loss * motion.structure().displacement_mm(6, t_s + 0.01), 0.002);
  }
}

TEST(TrackGenerator, FindsTheMaterialPointUnderAPixelOfATurnedDistortedView) {
  Scene scene = make_paper_scene(1, 30.0);
  scene.camera.lens = {LensParameters::Model::kRadialTangential, {-0.1, 0.02, 1e-3, -5e-4, 0.0}};
  scene.camera.roll_rad = 0.05;
  scene.camera.exposure_s = 0.0;
  scene.hover.roll_rms_rad = 0.005;
  scene.camera.readout_direction = core::ReadoutDirection::kLeft;
  const SceneMotion motion(scene);
  const ImagePoint pixel = motion.see(3, {80.0, 10.0}, 4.0);
  const PlanePoint point = motion.material_point(3, pixel, 4.0);
  EXPECT_NEAR(point.x_mm, 80.0, 1e-6);
  EXPECT_NEAR(point.y_mm, 10.0, 1e-6);
}

TEST(TrackGenerator, AddsNoiseOfTheDeclaredSpreadAndNothingElse) {
  const TrackGenerator tracks(make_paper_scene(1, 10.0));
  core::TrackFrame noisy, truth;
  double sum = 0.0, sum2 = 0.0;
  int n = 0;
  for (std::uint64_t frame = 0; frame < 250; ++frame) {
    tracks.generate(even_frame(frame), noisy);
    tracks.generate_true(even_frame(frame), truth);
    ASSERT_EQ(noisy.points.size(), 240U);
    for (std::size_t i = 0; i < noisy.points.size(); ++i) {
      EXPECT_TRUE(noisy.points[i].seen);
      for (const double d :
           {noisy.points[i].u_px - truth.points[i].u_px, noisy.points[i].v_px - truth.points[i].v_px}) {
        sum += d, sum2 += d * d, ++n;
      }
    }
  }
  EXPECT_NEAR(sum / n, 0.0, 5 * 0.03 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(sum2 / n), 0.03, 5 * 0.03 / std::sqrt(2.0 * n));
}

TEST(TrackGenerator, SpreadsTheNoiseOverThePointsAndStatesItWithAnError) {
  Scene scene = make_paper_scene(1, 10.0);
  scene.tracks.points_per_region = 400;
  scene.tracks.noise_spread = 0.4;
  scene.tracks.sigma_error = 0.2;
  const TrackGenerator tracks(scene);
  double squares = 0.0, log_noise = 0.0, log_noise2 = 0.0, log_error2 = 0.0, log_error = 0.0;
  for (const TrackGenerator::MaterialPoint& point : tracks.points()) {
    const double noise = std::log(point.noise_px / scene.tracks.noise_px),
                 error = std::log(point.stated_px / point.noise_px);
    squares += point.noise_px * point.noise_px;
    log_noise += noise, log_noise2 += noise * noise;
    log_error += error, log_error2 += error * error;
  }
  const auto n = static_cast<double>(tracks.points().size());
  EXPECT_NEAR(std::sqrt(squares / n), scene.tracks.noise_px, 0.05 * scene.tracks.noise_px);
  EXPECT_NEAR(std::sqrt(log_noise2 / n - log_noise / n * log_noise / n), 0.4, 0.03);
  EXPECT_NEAR(std::sqrt(log_error2 / n - log_error / n * log_error / n), 0.2, 0.015);
}

TEST(TrackGenerator, DrawsEachPointsNoiseAsLargeAsThatPointHasIt) {
  Scene scene = make_paper_scene(3, 40.0);
  scene.tracks.points_per_region = 2;
  scene.tracks.noise_spread = 0.8;
  const TrackGenerator tracks(scene);
  std::vector<double> squares(tracks.points().size(), 0.0);
  core::TrackFrame noisy, truth;
  constexpr int kFrames = 1000;
  for (std::uint64_t frame = 0; frame < kFrames; ++frame) {
    tracks.generate(even_frame(frame), noisy);
    tracks.generate_true(even_frame(frame), truth);
    for (std::size_t i = 0; i < squares.size(); ++i)
      squares[i] += std::pow(noisy.points[i].u_px - truth.points[i].u_px, 2);
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    EXPECT_NEAR(std::sqrt(squares[i] / kFrames), tracks.points()[i].noise_px, 0.12 * tracks.points()[i].noise_px);
    EXPECT_EQ(noisy.points[i].sigma_px, tracks.points()[i].noise_px) << "stated without an error";
  }
}

TEST(TrackGenerator, LosesTheDeclaredShareAndLeavesTheRestAlone) {
  const Scene scene = make_paper_scene(1, 10.0);
  Scene with_losses = scene;
  with_losses.tracks.loss_probability = 0.05;
  const TrackGenerator whole(scene), lossy(with_losses);
  core::TrackFrame a, b;
  int lost = 0, n = 0;
  for (std::uint64_t frame = 0; frame < 250; ++frame) {
    whole.generate(even_frame(frame), a);
    lossy.generate(even_frame(frame), b);
    for (std::size_t i = 0; i < a.points.size(); ++i, ++n) {
      EXPECT_EQ(a.points[i].u_px, b.points[i].u_px);
      EXPECT_EQ(b.points[i].seen, b.points[i].inlier);
      lost += b.points[i].seen ? 0 : 1;
    }
  }
  EXPECT_NEAR(lost / static_cast<double>(n), 0.05, 5 * std::sqrt(0.05 / n));
}

TEST(TrackGenerator, GivesAFrameAloneOrInSequence) {
  const TrackGenerator tracks(make_paper_scene(1, 10.0));
  core::TrackFrame sequence, alone;
  for (std::uint64_t frame = 0; frame <= 20; ++frame) tracks.generate(even_frame(frame), sequence);
  TrackGenerator(make_paper_scene(1, 10.0)).generate(even_frame(20), alone);
  EXPECT_EQ(alone.t_start_ns, 800'000'000);
  ASSERT_EQ(alone.points.size(), sequence.points.size());
  for (std::size_t i = 0; i < alone.points.size(); ++i) EXPECT_EQ(alone.points[i].u_px, sequence.points[i].u_px);
}

}  // namespace
}  // namespace core::simulation
