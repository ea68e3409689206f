#pragma once

#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/types/modal_estimate.h"
#include "firmware_app/config/config.h"

namespace tools {

struct TracksInput {
  core::closure::ObservationRecord record;
  std::vector<std::string> warnings;  // what was assumed
};

// tracks.csv, or the folder of a run that holds one, with the regions, the camera and its calibration as `config`
// declares them. Frames lie on the grid of their numbers. Throws drivers::FileError, app::ConfigError.
[[nodiscard]] TracksInput read_tracks_input(const std::string& path, const app::AppConfig& config);

// Modes of a modal.json (structural ones, shapes in the order of `channels` where all are named) or of a table with a
// column frequency_hz. Throws drivers::FileError.
[[nodiscard]] std::vector<core::Mode> read_known_modes(const std::string& path,
                                                       const std::vector<std::string>& channels);

}  // namespace tools
