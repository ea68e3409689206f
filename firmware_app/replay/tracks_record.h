#pragma once

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
// declares them. Frames lie on the grid of their numbers. Throws drivers::FileError, ConfigError.
[[nodiscard]] TracksRecord tracks_record(const drivers::TracksFile& file, const AppConfig& config);
[[nodiscard]] TracksRecord read_tracks_record(const std::string& path, const AppConfig& config);

}  // namespace app
