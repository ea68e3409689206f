#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/storage/csv.h"

namespace tools {

// Positions of a file's rows on a uniform grid.
struct SampleGrid {
  double rate_hz = 0.0;
  std::vector<std::int64_t> cell_of_row;  // ascending; -1 = the row is not used (its cell is taken)
  std::size_t n_cells = 0;
  std::vector<std::string> remarks;
};

// Index of the column of times in seconds (t_s, time, "t [s]", ...) or -1.
[[nodiscard]] int time_column(const drivers::SeriesFile& file);

// From the file's times (cell = round(t rate)), else its frame numbers, else row by row. rate_hz: stated by the user,
// 0 = not stated; then the file's own. Throws std::invalid_argument if the rate is unknown or disagrees with the times
// by more than 1 %, or if a gap would make more than 20 missing samples per row.
[[nodiscard]] SampleGrid sample_grid(const drivers::SeriesFile& file, double rate_hz, const std::string& path);

}  // namespace tools
