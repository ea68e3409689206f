#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "drivers/storage/tracks_file.h"
#include "firmware_app/config/config.h"

namespace app {

struct TracksRecord {
  core::closure::ObservationRecord record;
  std::vector<std::string> warnings;  // assumptions made
};

// Reads tracks.csv, or the folder of a run that contains one, with regions, camera and calibration as `config`
// declares them. Frames lie on the grid of their numbers; of more than most_frames the last ones are taken. Throws
// drivers::FileError (also where memory does not suffice for the diagnosis of that record), ConfigError.
[[nodiscard]] TracksRecord tracks_record(const drivers::TracksFile& file, const AppConfig& config,
                                         std::size_t most_frames = std::numeric_limits<std::size_t>::max());
[[nodiscard]] TracksRecord read_tracks_record(const std::string& path, const AppConfig& config);

}  // namespace app
