#include "core/geometry/readout_estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/simulation/presets.h"
#include "core/simulation/track_generator.h"

namespace core {
namespace {

using simulation::Scene;
constexpr double kDuration_s = 60.0;

Scene paper_scene(double readout_frames) {
  Scene scene = simulation::make_paper_scene(1, kDuration_s);
  scene.camera.readout_s = std::abs(readout_frames) / scene.camera.rate_hz;
  scene.tracks.points_per_region = 16;
  if (readout_frames < 0.0) scene.camera.readout_direction = ReadoutDirection::kUp;
  return scene;
}

ReadoutEstimator::Config config_of(const simulation::TrackGenerator& generator, ReadoutDirection direction) {
  const Scene& scene = generator.motion().scene();
  ReadoutEstimator::Config config;
  config.rate_hz = scene.camera.rate_hz;
  config.shear.n_regions = generator.regions().size();
  config.shear.readout = {0.0, direction, scene.camera.width_px, scene.camera.height_px};
  return config;
}

// spoil: applied to every frame except the first.
ReadoutEstimate estimate(const Scene& scene, ReadoutDirection direction = ReadoutDirection::kDown,
                         const std::function<void(TrackFrame&)>& spoil = {}) {
  const simulation::TrackGenerator generator(scene);
  simulation::FrameTiming timing = generator.timing();
  simulation::DeliveredFrame frame;
  TrackFrame tracks;
  EXPECT_TRUE(timing.next(frame));
  generator.generate(frame, tracks);
  ReadoutEstimator estimator(config_of(generator, direction), tracks);
  estimator.update(tracks);
  while (timing.next(frame)) {
    generator.generate(frame, tracks);
    if (spoil) spoil(tracks);
    estimator.update(tracks);
  }
  return estimator.estimate();
}

void expect_near(const ReadoutEstimate& found, double frames, double most_std_frames) {
  ASSERT_TRUE(found.observable);
  EXPECT_NEAR(found.frames, frames, 3.5 * found.std_frames);
  EXPECT_GT(found.std_frames, 1e-4);
  EXPECT_LT(found.std_frames, most_std_frames);
}

TEST(ReadoutEstimator, FindsTheReadoutOfSensorsReadDownAndUp) {
  for (const double readout : {-0.8, 0.0, 0.4, 1.0}) {
    SCOPED_TRACE(readout);
    expect_near(estimate(paper_scene(readout)), readout, 0.01);
  }
}

TEST(ReadoutEstimator, FindsTheReadoutAlongColumns) {
  Scene scene = paper_scene(0.6);
  scene.camera.readout_direction = ReadoutDirection::kRight;
  expect_near(estimate(scene, ReadoutDirection::kRight), 0.6, 0.02);
  expect_near(estimate(scene, ReadoutDirection::kLeft), -0.6, 0.02);
}

TEST(ReadoutEstimator, GustsThatTurnTheCameraLeaveItUnbiased) {
  Scene scene = paper_scene(0.7);
  scene.hover.pitch_rms_rad = scene.hover.yaw_rms_rad = scene.hover.roll_rms_rad = 0.01;
  scene.camera.alpha_px = 1500.0;
  expect_near(estimate(scene), 0.7, 0.03);
}

TEST(ReadoutEstimator, LostPointsLostFramesAndNanCostLittle) {
  Scene scene = paper_scene(0.7);
  scene.tracks.loss_probability = 0.05;
  scene.timing.drop_probability = 0.01;
  int n = 0;
  const ReadoutEstimate found = estimate(scene, ReadoutDirection::kDown, [&](TrackFrame& tracks) {
    tracks.points[static_cast<std::size_t>(++n) % tracks.points.size()].u_px = std::numeric_limits<double>::quiet_NaN();
    tracks.points[static_cast<std::size_t>(7 * n) % tracks.points.size()].v_px = 1e300;
  });
  expect_near(found, 0.7, 0.02);
}

TEST(ReadoutEstimator, WithoutMotionNothingIsObservable) {
  Scene scene = paper_scene(0.7);
  scene.excitation.rms_mm = 0.0;
  scene.hover = {0.0, 0.0, 0.0};
  EXPECT_FALSE(estimate(scene).observable);
}

TEST(ReadoutEstimator, PointsOnOneLineTellNothing) {
  const ReadoutEstimate found = estimate(paper_scene(0.7), ReadoutDirection::kDown, [](TrackFrame& tracks) {
    for (TrackPoint& point : tracks.points) point.seen = point.id % 16 < 3;
  });
  EXPECT_FALSE(found.observable);
  EXPECT_EQ(found.n_bands, 0);
}

// A spectral line above half the rate, stronger than all other motion: its velocity has the wrong sign in the samples.
TEST(ReadoutEstimator, LeavesOutFoldedMotion) {
  Scene scene = paper_scene(0.7);
  scene.excitation.harmonics.push_back({6, 16.0, 6.0});
  const ReadoutEstimate found = estimate(scene);
  expect_near(found, 0.7, 0.02);
  EXPECT_GE(found.n_bands_against, 1);
}

TEST(ReadoutEstimator, SameFramesGiveTheSameBits) {
  const ReadoutEstimate a = estimate(paper_scene(0.5)), b = estimate(paper_scene(0.5));
  EXPECT_EQ(a.frames, b.frames);
  EXPECT_EQ(a.std_frames, b.std_frames);
}

TEST(ReadoutEstimator, RefusesWhatCannotBe) {
  ReadoutEstimator::Config config;
  config.shear.n_regions = 1;
  TrackFrame keyframe;
  EXPECT_THROW(ReadoutEstimator(config, keyframe), std::invalid_argument);
  config.rate_hz = 25.0;
  EXPECT_NO_THROW(ReadoutEstimator(config, keyframe));
  keyframe.points.resize(1);
  keyframe.points[0].region = 1;
  EXPECT_THROW(ReadoutEstimator(config, keyframe), std::invalid_argument);
}

TEST(ReadoutEstimator, AKeyframeOfNothingButNanIsNotObservable) {
  ReadoutEstimator::Config config;
  config.shear.n_regions = 1;
  config.rate_hz = 25.0;
  TrackFrame tracks;
  tracks.points.resize(9);
  for (TrackPoint& point : tracks.points) point.u_px = point.sigma_px = std::numeric_limits<double>::quiet_NaN();
  ReadoutEstimator estimator(config, tracks);
  for (int k = 0; k < 1000; ++k) {
    tracks.t_start_ns = std::int64_t{40'000'000} * k;
    estimator.update(tracks);
  }
  EXPECT_FALSE(estimator.estimate().observable);
}

}  // namespace
}  // namespace core
