#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace drivers {

// A column by its name without unit: "altitude" also matches " Altitude(meters)". The first of `names` that exists is
// used.
struct ColumnWish {
  std::vector<std::string> names;
  std::string meaning;  // for messages
  double turn = 0.0;    // of an angle, 360: whole turns are added so that no step exceeds half of one; 0 = not an angle
};

// What to read from a CSV with a column of times. All of `columns` must be numbers between from_s and to_s; other
// columns may contain anything, including quoted text with commas; surplus cells are treated as trailing commas.
struct TimedColumnsWish {
  ColumnWish time;
  double seconds_per_unit = 1.0;
  bool first_row_is_zero = false;  // times count from the first row, which is at offset_s
  double offset_s = 0.0;
  std::vector<ColumnWish> columns;
  double from_s = 0.0, to_s = 0.0;
};

// The rows between from_s and to_s, at a uniform rate: that of the median step, linear between rows, so that rows
// on the grid are unchanged.
struct TimedColumns {
  double rate_hz = 0.0;
  double from_s = 0.0;
  std::vector<std::string> names;            // as in the file
  std::vector<std::vector<double>> columns;  // per wish
};

// Throws std::invalid_argument on invalid time limits, FileError "FILE:LINE: ..." on a missing column (and lists the
// existing ones), text in place of a number, decreasing times, a gap of more than three steps, a stretch outside the
// record (and states the record's), fewer than 16 rows.
[[nodiscard]] TimedColumns read_timed_columns(const std::string& path, const TimedColumnsWish& wish);

// Cells of a line; commas inside of double quotes do not split. Trimmed, quotes removed.
void split_quoted_cells(std::string_view line, std::vector<std::string_view>& cells);

}  // namespace drivers
