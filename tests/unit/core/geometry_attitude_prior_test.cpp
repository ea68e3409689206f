#include "core/geometry/attitude_prior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/simulation/presets.h"
#include "core/simulation/random_stream.h"
#include "core/simulation/track_generator.h"

namespace core {
namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kAttitudeRate_hz = 50.0;

// The paper's frame, 20 s, seen from a camera that gusts rotate by two degrees rms about each axis.
simulation::Scene gusty_scene(std::uint64_t seed) {
  simulation::Scene scene = simulation::make_paper_scene(seed, 20.0);
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  scene.hover.pitch_rms_rad = scene.hover.yaw_rms_rad = scene.hover.roll_rms_rad = 2.0 * kRadPerDeg;
  scene.camera.alpha_px = 1200.0;
  return scene;
}

// Attitudes stated by an autopilot at the camera, from a tenth of a second before the first frame on.
std::vector<AttitudeSample> told_attitude(const simulation::TrackGenerator& tracks, double sigma_rad) {
  simulation::RandomStream noise(tracks.motion().scene().seed, "attitude");
  Eigen::Matrix3d body_to_camera;
  body_to_camera << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0;
  std::vector<AttitudeSample> samples;
  const double end_s = tracks.motion().scene().duration_s + 0.2;
  for (int k = -5; k / kAttitudeRate_hz < end_s; ++k) {
    const double t_s = k / kAttitudeRate_hz;
    const Eigen::Vector3d e{noise.gaussian(), noise.gaussian(), noise.gaussian()};
    const Eigen::Quaterniond error(Eigen::AngleAxisd(sigma_rad * e.norm(), e.normalized()));
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(Eigen::Matrix3d(tracks.motion().camera().at(t_s).attitude * body_to_camera)) * error;
    samples.push_back({t_s, {q.w(), q.x(), q.y(), q.z()}});
  }
  return samples;
}

struct Flight {
  double error_px = 0.0;  // rms of the common motion remaining in the channels, without its mean
  bool given_up = false;
  std::uint64_t n_used = 0;
};

Flight fly(const simulation::TrackGenerator& tracks, bool with_background,
           const std::optional<AttitudeConfig>& attitude) {
  const auto& scene = tracks.motion().scene();
  ChannelDisplacementConfig config;
  for (const auto& [body, region] : tracks.regions()) {
    if (region.role == RegionRole::kBackground && !with_background) continue;
    config.regions.push_back(region);
    if (region.role == RegionRole::kBackground) config.regions.back().depth_m = 4.0;
  }
  const auto& camera = scene.camera;
  config.camera = {camera.alpha_px, camera.alpha_px, camera.cx_px, camera.cy_px, {}};
  config.readout = {camera.readout_s, camera.readout_direction, camera.width_px, camera.height_px};
  config.rate_hz = camera.rate_hz;
  config.scale_mm_per_px = (scene.plates[0].z_mm - tracks.motion().camera().at(0.0).z_mm) / camera.alpha_px;
  config.attitude = attitude;
  if (attitude) config.attitude->delay_s = 0.5 * camera.exposure_s;

  auto timing = tracks.timing();
  simulation::DeliveredFrame frame;
  TrackFrame points;
  std::unique_ptr<ChannelDisplacement> channels;
  DisplacementSample sample;
  double sum = 0.0, squares = 0.0, n = 0.0;
  while (timing.next(frame)) {
    tracks.generate(frame, points);
    std::erase_if(points.points, [&](const TrackPoint& p) { return p.region >= config.regions.size(); });
    if (!channels) {
      channels = std::make_unique<ChannelDisplacement>(config, points);
      sample = channels->sample_prototype();
    }
    channels->update(points, sample);
    const std::size_t last = channels->channels().size() - 1;
    const ChannelInfo& info = channels->channels()[last];
    const double t_s = frame.t_s + info.row_delay_s + 0.5 * camera.exposure_s;
    const double error_px =
        (sample.value_mm[last] - tracks.motion().body_at(tracks.regions()[info.region].body, t_s).x_mm) /
        config.scale_mm_per_px;
    sum += error_px, squares += error_px * error_px, n += 1.0;
  }
  const AttitudePrior* prior = channels->attitude();
  return {std::sqrt(std::max(0.0, squares / n - sum / n * sum / n)), prior != nullptr && prior->given_up(),
          prior != nullptr ? prior->n_used() : 0};
}

AttitudeConfig told(const simulation::TrackGenerator& tracks, double sigma_deg) {
  AttitudeConfig config;
  config.sigma_rad = sigma_deg * kRadPerDeg;
  config.record = told_attitude(tracks, config.sigma_rad);
  return config;
}

TEST(AttitudePrior, ExactAttitudeTakesGustsAwayWhereNothingRests) {
  const simulation::TrackGenerator tracks(gusty_scene(1));
  AttitudeConfig exact = told(tracks, 0.0);
  exact.sigma_rad = 1e-6;
  const Flight without = fly(tracks, false, std::nullopt), with = fly(tracks, false, exact);
  EXPECT_GT(without.error_px, 15.0);
  EXPECT_LT(with.error_px, 0.1);
  EXPECT_FALSE(with.given_up);
  EXPECT_GT(with.n_used, 490U);
}

TEST(AttitudePrior, NoisyAttitudeLeavesLessThanItsOwnNoise) {
  for (const double sigma_deg : {0.05, 0.1}) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const simulation::TrackGenerator tracks(gusty_scene(seed));
      const Flight with = fly(tracks, false, told(tracks, sigma_deg));
      EXPECT_LT(with.error_px, sigma_deg * kRadPerDeg * tracks.motion().scene().camera.alpha_px) << sigma_deg << seed;
      EXPECT_FALSE(with.given_up);
    }
  }
}

TEST(AttitudePrior, DoesNotSpoilWhatABackgroundTellsBetter) {
  const simulation::TrackGenerator tracks(gusty_scene(2));
  const Flight without = fly(tracks, true, std::nullopt), with = fly(tracks, true, told(tracks, 0.1));
  EXPECT_LT(with.error_px, 1.05 * without.error_px + 0.01);
  EXPECT_FALSE(with.given_up);
}

TEST(AttitudePrior, WrongMountingIsToldAndGivenUp) {
  const simulation::TrackGenerator tracks(gusty_scene(3));
  AttitudeConfig wrong = told(tracks, 0.05);
  wrong.mount_rpy_rad = {0.0, 0.0, 0.5 * std::numbers::pi};
  const Flight without = fly(tracks, true, std::nullopt), with = fly(tracks, true, wrong);
  EXPECT_TRUE(with.given_up);
  EXPECT_LT(with.n_used, 250U);
  EXPECT_LT(with.error_px, 2.0 * without.error_px + 1.0);
  EXPECT_TRUE(fly(tracks, false, wrong).given_up);
}

TEST(AttitudePrior, MountingTurnsTheBodysAxesIntoTheCameras) {
  // A body that rolls to the right under a camera that looks to its right: the camera pitches up.
  AttitudeConfig config;
  config.mount_rpy_rad = {0.0, 0.0, 0.5 * std::numbers::pi};
  const double angle = 0.1;
  config.record = {{0.0, attitude_of(0.0, 0.0, 0.3)}, {0.1, attitude_of(angle, 0.0, 0.3)}};
  const AttitudePrior prior(config);
  const Eigen::Quaterniond turn = prior.at(0.1)->camera.conjugate() * prior.at(0.0)->camera;
  EXPECT_NEAR(turn.angularDistance(Eigen::Quaterniond::Identity()), angle, 1e-12);
  EXPECT_NEAR(turn.x() / std::sin(0.5 * angle), turn.w() > 0.0 ? 1.0 : -1.0, 1e-9);
}

TEST(AttitudePrior, InterpolatesHoldsTheNewestForAWhileAndTellsNothingBeyond) {
  AttitudeConfig config;
  config.sigma_rad = 0.01;
  config.record = {{1.0, attitude_of(0.0, 0.0, 0.0)}, {1.1, attitude_of(0.0, 0.0, 0.02)}};
  const AttitudePrior prior(config);
  EXPECT_FALSE(prior.at(0.99));
  ASSERT_TRUE(prior.at(1.05));
  EXPECT_NEAR(prior.at(1.05)->camera.angularDistance(prior.at(1.0)->camera), 0.01, 1e-12);
  EXPECT_DOUBLE_EQ(prior.at(1.05)->sigma_rad, 0.01);
  ASSERT_TRUE(prior.at(1.2));
  EXPECT_NEAR(prior.at(1.2)->sigma_rad, std::hypot(0.01, 0.02), 1e-9);
  EXPECT_FALSE(prior.at(1.4));
  EXPECT_FALSE(prior.at(std::numeric_limits<double>::quiet_NaN()));
}

TEST(AttitudePrior, CountsWhatIsNoAttitudeAndForgetsTheOldest) {
  AttitudeConfig config;
  config.n_kept = 4;
  AttitudePrior prior(config);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  prior.take({0.0, {0.0, 0.0, 0.0, 0.0}});
  prior.take({0.0, {nan, 0.0, 0.0, 0.0}});
  prior.take({nan, {1.0, 0.0, 0.0, 0.0}});
  prior.take({0.0, {inf, 0.0, 0.0, 0.0}});
  prior.take({0.0, {1e300, 1e300, 0.0, 0.0}});
  EXPECT_EQ(prior.n_refused(), 5U);
  EXPECT_FALSE(prior.at(0.0));
  for (int k = 0; k < 10; ++k) prior.take({0.1 * k, {2.0, 0.0, 0.0, 0.0}});
  prior.take({0.5, {1.0, 0.0, 0.0, 0.0}});
  EXPECT_EQ(prior.n_refused(), 6U);
  EXPECT_FALSE(prior.at(0.55));
  EXPECT_TRUE(prior.at(0.65));
}

}  // namespace
}  // namespace core
