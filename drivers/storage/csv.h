#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace drivers {

// A table of numbers under one line of column names. `#` lines before it are comments; "# key: value" is kept.
struct SeriesFile {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;  // one per name, equally long; NaN where a cell is empty or "nan"
  std::map<std::string, std::string> comments;
  std::vector<std::string> units;  // per column, from its name or the file's head; "" = not stated
  std::optional<double> rate_hz;   // from the head of a LabVIEW measurement file
  bool has_names = true;           // false: no line of names, the columns are called c1, c2, ...
  std::uint64_t n_not_finite = 0;  // infinities, taken as missing

  [[nodiscard]] int column(const std::string& name) const noexcept;  // -1 = not there
};

// Formats of other programs. Separators comma, semicolon, tab or white space, decimal commas where the separator is
// not a comma, with or without names, `#` or `%` comments, the head of LabVIEW's .lvm; infinities count as missing.
struct ForeignFormat {
  bool no_names = false;  // the first line must contain numbers
  // Called at intervals with the number of lines read.
  std::function<void(std::uint64_t n_lines)> progress = {};
};

// All throw FileError "FILE:LINE: ..." on any deviation from the format: ragged rows, text in place of a number,
// over-long lines, NUL bytes, no header, frames or times that decrease.
[[nodiscard]] SeriesFile read_series_csv(const std::string& path);
[[nodiscard]] SeriesFile read_foreign_series(const std::string& path, const ForeignFormat& format = {});

}  // namespace drivers
