#include "core/geometry/camera_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/keyframe_view.h"
#include "core/simulation/presets.h"
#include "core/simulation/track_generator.h"

namespace core {
namespace {

using simulation::kBackgroundBody;
using simulation::Scene;
using simulation::TrackGenerator;

// The paper's frame in a view wide enough for gusts of 5 degrees in every axis.
Scene gusty_scene(double gust_deg) {
  Scene scene = simulation::make_paper_scene(1, 20.0);
  scene.hover.pitch_rms_rad = scene.hover.yaw_rms_rad = scene.hover.roll_rms_rad = gust_deg * std::numbers::pi / 180.0;
  scene.camera.width_px = scene.camera.height_px = 4000;
  scene.camera.cx_px = scene.camera.cy_px = 1999.5;
  return scene;
}

ChannelDisplacementConfig config_of(const TrackGenerator& tracks, double background_m) {
  const auto& camera = tracks.motion().scene().camera;
  ChannelDisplacementConfig config;
  for (const auto& [body, region] : tracks.regions()) {
    config.regions.push_back(region);
    if (body == kBackgroundBody) config.regions.back().depth_m = background_m;
  }
  config.camera = {camera.alpha_px, camera.alpha_px, camera.cx_px, camera.cy_px, {}};
  config.readout = {camera.readout_s, camera.readout_direction, camera.width_px, camera.height_px};
  config.rate_hz = camera.rate_hz;
  const double depth_mm = tracks.motion().scene().plates[0].z_mm - tracks.motion().camera().at(0.0).z_mm;
  config.scale_mm_per_px = depth_mm / camera.alpha_px;
  return config;
}

double rms(const std::vector<double>& x) {
  double sum = 0.0, square = 0.0;
  for (const double v : x) sum += v, square += v * v;
  const auto n = static_cast<double>(x.size());
  return std::sqrt(std::max(0.0, square / n - sum / n * sum / n));
}

struct Errors {
  double common_px, between_px;
};

// visit(channels, frame, sample) for every frame.
template <class Visit>
void for_each_sample(const TrackGenerator& tracks, const ChannelDisplacementConfig& config, const Visit& visit) {
  auto timing = tracks.timing();
  simulation::DeliveredFrame frame;
  TrackFrame points;
  std::unique_ptr<ChannelDisplacement> channels;
  DisplacementSample sample;
  while (timing.next(frame)) {
    tracks.generate(frame, points);
    if (!channels) {
      channels = std::make_unique<ChannelDisplacement>(config, points);
      sample = channels->sample_prototype();
    }
    channels->update(points, sample);
    visit(*channels, frame, sample);
  }
}

Errors errors_of(const TrackGenerator& tracks, const ChannelDisplacementConfig& config) {
  std::vector<double> common, between;
  for_each_sample(tracks, config, [&](const auto& channels, const auto& frame, const auto& sample) {
    const auto error = [&](std::size_t c) {
      const ChannelInfo& info = channels.channels()[c];
      const double t_s = frame.t_s + info.row_delay_s + 0.5 * tracks.motion().scene().camera.exposure_s;
      const int body = tracks.regions()[info.region].body;
      return (sample.value_mm[c] - tracks.motion().body_at(body, t_s).x_mm) / config.scale_mm_per_px;
    };
    const std::size_t last = channels.channels().size() - 1;
    common.push_back(error(last));
    between.push_back(error(0) - error(last));
  });
  return {rms(common), rms(between)};
}

// The base is static, and declared as such.
ChannelDisplacementConfig with_ground(ChannelDisplacementConfig config) {
  for (Region& region : config.regions) {
    if (region.role == RegionRole::kBase) region.role = RegionRole::kGround;
  }
  return config;
}

TEST(CameraMotionEstimate, GustsAreTakenAwayByABackgroundOfKnownDistance) {
  const TrackGenerator tracks(gusty_scene(5.0));
  ChannelDisplacementConfig config = config_of(tracks, 4.0);
  const Errors ours = errors_of(tracks, config);
  config.following = CameraFollowing::kDistance;
  const Errors scale_only = errors_of(tracks, config);
  EXPECT_GT(scale_only.common_px, 50.0);
  EXPECT_LT(ours.common_px, 0.1 * scale_only.common_px);
  EXPECT_LT(ours.between_px, 0.1 * scale_only.between_px);
}

// Differences of channels show what no common motion expresses, above all the roll.
TEST(CameraMotionEstimate, FollowingTheSlowRotationHalvesWhatGustsLeaveBetweenChannels) {
  const TrackGenerator tracks(gusty_scene(5.0 / 3.0));
  ChannelDisplacementConfig config = config_of(tracks, 4.0);
  config.following = CameraFollowing::kSlow;
  const Errors slow = errors_of(tracks, config);
  config.following = CameraFollowing::kDistance;
  EXPECT_LT(slow.between_px, 0.5 * errors_of(tracks, config).between_px);
}

// Translation looks like rotation to a background: for one twice as far away, half of it is removed.
TEST(CameraMotionEstimate, DriftIsHalvedByABackgroundAndTakenAwayByGroundInTheStructuresPlane) {
  Scene scene = simulation::make_paper_scene(2, 20.0);
  scene.excitation.rms_mm = 0.0;
  const TrackGenerator tracks(scene);
  ChannelDisplacementConfig config = config_of(tracks, 4.0);
  const Errors by_background = errors_of(tracks, config);
  config.following = CameraFollowing::kDistance;
  const Errors scale_only = errors_of(tracks, config);
  config.following = CameraFollowing::kWhole;
  const Errors by_ground = errors_of(tracks, with_ground(config));
  EXPECT_LT(by_background.common_px, 0.6 * scale_only.common_px);
  EXPECT_LT(by_ground.common_px, 0.02 * scale_only.common_px);
}

TEST(CameraMotionEstimate, ACameraAtRestAddsNoMoreNoiseThanItsBackgroundHas) {
  Scene scene = simulation::make_paper_scene(2, 20.0);
  scene.excitation.rms_mm = 0.0;
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  const TrackGenerator tracks(scene);
  const double points = scene.tracks.points_per_region;
  const Errors errors = errors_of(tracks, config_of(tracks, 4.0));
  EXPECT_LT(errors.common_px, 2.0 * scene.tracks.noise_px * std::sqrt(2.0 / points));
}

// From one sample to the next.
double step_rms(const std::vector<double>& x) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < x.size(); ++k) steps.push_back(x[k] - x[k - 1]);
  return rms(steps);
}

// Scatter of every channel's error over its stated sigma, over seeds; the ground is static in the structure's plane.
// From sample to sample: a keyframe read while the camera moved is deformed, which shows slowly as the distance
// changes.
TEST(CameraMotionEstimate, StatesHowFarItMayBeOff) {
  double square = 0.0, n = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Scene scene = simulation::make_paper_scene(seed, 16.0);
    scene.excitation.rms_mm = 0.0;
    const TrackGenerator tracks(scene);
    std::vector<std::vector<double>> ratio;
    int k = 0;
    for_each_sample(tracks, with_ground(config_of(tracks, 4.0)),
                    [&](const auto& channels, const auto&, const auto& sample) {
                      ratio.resize(channels.channels().size());
                      for (std::size_t c = 0; k > 100 && c < ratio.size(); ++c) {
                        ratio[c].push_back(sample.value_mm[c] / sample.sigma_mm[c]);
                      }
                      ++k;
                    });
    for (const auto& values : ratio) square += step_rms(values) * step_rms(values) / 2.0, n += 1.0;
  }
  EXPECT_GT(std::sqrt(square / n), 0.6);
  EXPECT_LT(std::sqrt(square / n), 1.5);
}

// No motion is invented: yaw and the shift along the axes stay zero, and so does their noise.
// A structure alone cannot distinguish its own rotation from the camera's.
TEST(CameraMotionEstimate, NeedsAFocalLengthAndSomethingThatRests) {
  const TrackGenerator tracks(gusty_scene(1.0));
  ChannelDisplacementConfig config = config_of(tracks, 0.0);
  EXPECT_TRUE(tells_camera_motion(config.regions, config.camera));
  EXPECT_FALSE(tells_camera_motion(config.regions, CameraModel{}));
  config.regions.pop_back();
  EXPECT_FALSE(tells_camera_motion(config.regions, config.camera));
}

TEST(CameraMotionEstimate, HostileTracksLeaveNoNaN) {
  const TrackGenerator tracks(simulation::make_paper_scene(3, 4.0));
  ChannelDisplacementConfig config = config_of(tracks, 4.0);
  auto timing = tracks.timing();
  simulation::DeliveredFrame frame;
  TrackFrame points;
  ASSERT_TRUE(timing.next(frame));
  tracks.generate(frame, points);
  ChannelDisplacement channels(config, points);
  DisplacementSample sample = channels.sample_prototype();
  for (int k = 0; timing.next(frame); ++k) {
    tracks.generate(frame, points);
    for (std::size_t i = 0; i < points.points.size(); ++i) {
      TrackPoint& point = points.points[i];
      if (k % 7 == 1) point.seen = false;
      if (k % 7 == 2) point.u_px = std::numeric_limits<double>::quiet_NaN();
      if (k % 7 == 3) point.sigma_px = i % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : -1.0;
      if (k % 7 == 4) point.v_px = i % 3 == 0 ? 1e300 : point.v_px;
      if (k % 7 == 5) point.u_px = 1e9;
    }
    if (k % 11 == 6) points.t_start_ns = 0;
    channels.update(points, sample);
    EXPECT_TRUE(channels.camera_motion()->state().allFinite()) << k;
    EXPECT_TRUE(channels.camera_motion()->covariance().allFinite()) << k;
    EXPECT_TRUE(std::isfinite(sample.scale_mm_per_px)) << k;
    for (std::size_t c = 0; c < sample.value_mm.size(); ++c)
      EXPECT_TRUE(std::isfinite(sample.value_mm[c]) && (sample.seen[c] == 0 || !std::isnan(sample.sigma_mm[c]))) << k;
  }
}

}  // namespace
}  // namespace core
