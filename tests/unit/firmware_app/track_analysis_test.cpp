#include "firmware_app/replay/track_analysis.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "core/simulation/presets.h"
#include "core/simulation/track_generator.h"

namespace app {
namespace {

using core::simulation::Scene;
using core::simulation::TrackGenerator;

const char* role_of(core::RegionRole role) {
  if (role == core::RegionRole::kBackground) return "background";
  return role == core::RegionRole::kBase ? "base" : "structure";
}

AppConfig config_of(const TrackGenerator& tracks, const std::string& more) {
  const auto& camera = tracks.motion().scene().camera;
  std::string text = "camera: {source: a.mp4}\n";
  text += fmt::format("calibration: {{fx: {0}, fy: {0}, cx: {1}, cy: {2}}}\nregions:\n", camera.alpha_px, camera.cx_px,
                      camera.cy_px);
  for (const auto& [body, region] : tracks.regions()) {
    text += fmt::format("  - {{name: {}, rect: [{}, {}, {}, {}], role: {}{}}}\n", region.name, region.u_px, region.v_px,
                        region.width_px, region.height_px, role_of(region.role),
                        region.role == core::RegionRole::kBackground ? ", depth_m: 4" : "");
  }
  text += fmt::format("scale: {{known_length_mm: 300, from: [600, 500], to: [{}, 500]{}}}\n",
                      600.0 + 300.0 * camera.alpha_px / tracks.motion().scene().plates[0].z_mm, more);
  return parse_config(text + "spectrum: {segment: 512}\nclosure: {adopt: off}\n", "a.yaml");
}

core::CameraInfo info_of(const Scene& scene) {
  core::CameraInfo info;
  info.width_px = scene.camera.width_px, info.height_px = scene.camera.height_px, info.rate_hz = scene.camera.rate_hz;
  info.readout_ns = std::llround(1e9 * scene.camera.readout_s);
  return info;
}

// The region declared static sways at 0.9 Hz by `sway_px`.
core::ModalEstimate estimate_with(double sway_px, const std::string& more) {
  const TrackGenerator tracks(core::simulation::make_paper_scene(1, 90.0));
  const AppConfig config = config_of(tracks, more);
  std::unique_ptr<TrackAnalysis> analysis;
  core::TrackFrame frame;
  auto timing = tracks.timing();
  for (core::simulation::DeliveredFrame delivered; timing.next(delivered);) {
    tracks.generate(delivered, frame);
    const double u_px = sway_px * std::sin(2.0 * std::numbers::pi * 0.9 * delivered.t_s);
    for (core::TrackPoint& point : frame.points) {
      if (config.regions[point.region].role == core::RegionRole::kBackground) point.u_px += u_px;
    }
    if (!analysis) analysis = std::make_unique<TrackAnalysis>(config, info_of(tracks.motion().scene()), frame);
    (void)analysis->push(frame);
  }
  return analysis->analysis().finish();
}

bool has_mode(const core::ModalEstimate& estimate, double frequency_hz) {
  for (const core::Mode& mode : estimate.modes) {
    if (std::abs(mode.frequency_hz / frequency_hz - 1.0) < 0.02) return true;
  }
  return false;
}

constexpr const char* kWholeMotion = ", only: false";

TEST(TrackAnalysis, FindsTheModesUnderAMovingCamera) {
  const core::ModalEstimate estimate = estimate_with(0.0, kWholeMotion);
  EXPECT_TRUE(has_mode(estimate, 1.657));
  EXPECT_TRUE(has_mode(estimate, 5.04));
  EXPECT_TRUE(has_mode(estimate, 8.14));
}

// The sway looks like camera rotation, so all channels get it: no mode moves its base as much.
TEST(TrackAnalysis, ABackgroundThatMovesMakesNoMode) {
  const core::ModalEstimate estimate = estimate_with(3.0, kWholeMotion);
  EXPECT_FALSE(has_mode(estimate, 0.9));
  bool told = false;
  for (const core::Mode& pole : estimate.rejected) {
    told = told || (std::abs(pole.frequency_hz - 0.9) < 0.03 && !pole.reason.empty() &&
                    (pole.verdict == core::Verdict::kInputPeak || pole.verdict == core::Verdict::kCameraMotion ||
                     pole.verdict == core::Verdict::kHarmonic));
  }
  EXPECT_TRUE(told);
  EXPECT_TRUE(has_mode(estimate, 1.657));
  EXPECT_TRUE(has_mode(estimate, 5.04));
}

}  // namespace
}  // namespace app
