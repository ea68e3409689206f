#pragma once

#include <string>
#include <vector>

#include "firmware_app/replay/analysis.h"

namespace tools {

// The user's statements about the files of a record, as on the command line.
struct SeriesRequest {
  double rate_hz = 0.0;  // 0 = from the file
  bool no_header = false;
  std::vector<std::string> channels;    // names or numbers from 1; empty = all except times
  std::vector<std::string> quantities;  // d, v or a: one for all, or one per channel; empty = from the units
  std::vector<std::string> bases;
  std::vector<double> delays_ms;  // one per channel; empty = from the file's comments
  bool is_quiet = false;          // no progress
  std::string input;              // measured ground or shaker table; empty = none
};

// A file as channels on a uniform grid, and the findings and assumptions about it.
struct LoadedSeries {
  app::ChannelSeries series;
  std::vector<std::size_t> columns;  // per channel, number in the file, from 1
  std::vector<std::string> remarks;
  double first_s = 0.0;  // time of the first sample in the file; 0 without times
};

// Rows are placed by their times or frame numbers, if the file has them: cells between are missing. Progress of
// long files goes to standard error, unless `is_quiet`. Throws std::invalid_argument on a request that does not fit the
// file, FileError on a file that is not a table of numbers.
[[nodiscard]] LoadedSeries load_series(const std::string& path, const SeriesRequest& request);

// Index of the channel of that name, or from that column (number from 1) of the file; throws std::invalid_argument.
[[nodiscard]] int channel_index(const LoadedSeries& loaded, const std::string& wanted, const std::string& path);

}  // namespace tools
