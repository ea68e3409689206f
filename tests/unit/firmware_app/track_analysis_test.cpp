#include "firmware_app/replay/track_analysis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "core/simulation/presets.h"
#include "core/simulation/track_generator.h"
#include "tests/support/track_config.h"

namespace app {
namespace {

using core::simulation::TrackGenerator;

// The region declared static sways at 0.9 Hz by `sway_px`.
core::ModalEstimate estimate_with(double sway_px, const std::string& more) {
  const TrackGenerator tracks(core::simulation::make_paper_scene(1, 90.0));
  const AppConfig config = tests::track_config(tracks, "spectrum: {segment: 512}\nclosure: {adopt: off}\n", 0.0, more);
  std::unique_ptr<TrackAnalysis> analysis;
  core::TrackFrame frame;
  auto timing = tracks.timing();
  for (core::simulation::DeliveredFrame delivered; timing.next(delivered);) {
    tracks.generate(delivered, frame);
    const double u_px = sway_px * std::sin(2.0 * std::numbers::pi * 0.9 * delivered.t_s);
    for (core::TrackPoint& point : frame.points) {
      if (config.regions[point.region].role == core::RegionRole::kBackground) point.u_px += u_px;
    }
    if (!analysis) analysis = std::make_unique<TrackAnalysis>(config, tests::track_camera(tracks), frame);
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
