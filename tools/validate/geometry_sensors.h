#pragma once

#include <string>
#include <vector>

#include "core/simulation/scene.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/replay/analysis.h"
#include "tools/validate/geometry_flight.h"

namespace tools {

// The sensors of the paper's Table 1 on one shaken structure: the same motion, measured in three ways.

// Absolute accelerations of the floors, mm/s2, at 1024 Hz: second difference of the displacement (0.1 % low at 20 Hz,
// alike in all channels) and white noise of 5 mm/s2 rms (0.5 mg), as of an ordinary sensor on a laboratory frame.
[[nodiscard]] app::ChannelSeries accelerations(const core::simulation::Scene& scene);

// A telephone on the ground, 1 m away: 1080p at 60 fps, readout 0.7 of a frame. Its
// displacements are resampled to 25 Hz (band-limited, flat to 11 Hz). Gives the samples of all regions, from `first_s`
// on.
struct StationaryRecord {
  app::ChannelSeries series;
  double first_s = 0.0;
};
[[nodiscard]] StationaryRecord stationary_camera(std::uint64_t seed, double duration_s);

// The aircraft 2 m away: 25 fps, readout 0.7 of a frame.
[[nodiscard]] FlightSetup paper_flight(double readout_ms = 28.0);

}  // namespace tools
