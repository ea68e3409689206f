#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/hovermodal/answer.h"

namespace tools {

// `closeloop --record DIR|tracks.csv --config FILE`: the observation level.
struct TracksLoop {
  std::string record, config, reference, report;
  std::vector<std::string> overrides;
  std::uint64_t seed = 1;
  std::size_t n_surrogates = 0;
  Answer answer;
};

// A folder, or a file that has the header of a tracks.csv.
[[nodiscard]] bool is_tracks_record(const std::string& path);
// Throws std::invalid_argument, drivers::FileError, app::ConfigError.
void close_tracks(const TracksLoop& request);

}  // namespace tools
