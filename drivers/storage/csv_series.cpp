#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "drivers/storage/csv.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/series_room.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

bool is_nan_text(std::string_view cell) { return cell == "nan" || cell == "NaN" || cell == "NAN"; }

bool is_text(std::string_view cell) {
  try {
    require_text(cell, "");
    return true;
  } catch (const FileError&) {
    return false;
  }
}

class SeriesReader {
 public:
  explicit SeriesReader(const std::string& path) : lines_(path) {}

  [[nodiscard]] SeriesFile read() {
    read_header();
    std::string_view line;
    while (lines_.next(line)) {
      // In a table of one column an empty line is a missing value.
      if (line.empty() && out_.names.size() > 1) continue;
      read_row(line);
    }
    if (out_.columns.front().empty()) lines_.fail("no row of numbers under the header");
    return std::move(out_);
  }

 private:
  void read_header() {
    std::string_view line;
    do {
      if (!lines_.next(line)) lines_.fail("no header line with the names of the columns");
      std::string key, value;
      if (split_comment(line, key, value)) room_.keep_comment(lines_, key, value, out_);
    } while (line.starts_with('#') || line.empty());
    split_cells(line, cells_);
    if (std::all_of(cells_.begin(), cells_.end(),
                    [](std::string_view cell) { return parse_number(cell).has_value(); })) {
      lines_.fail("the first line holds numbers; write the names of the columns above it");
    }
    for (std::string_view cell : cells_) {
      if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
      if (cell.empty() || cell.size() > 64) lines_.fail("a column's name is empty or longer than 64 characters");
      if (!is_text(cell)) lines_.fail("a column's name is no UTF-8 text");
      if (out_.column(std::string(cell)) >= 0) lines_.fail(fmt::format("column `{}` appears twice", printable(cell)));
      out_.names.emplace_back(cell);
    }
    out_.columns.resize(out_.names.size());
    room_.reserve(lines_, out_);
    // Columns that must not decrease.
    i_frame_ = out_.column("frame");
    i_time_ = out_.column("t_s");
  }

  void read_row(std::string_view line) {
    split_cells(line, cells_);
    if (cells_.size() != out_.names.size()) {
      lines_.fail(fmt::format("{} cells instead of {}; is the file cut off?", cells_.size(), out_.names.size()));
    }
    room_.require(lines_, out_);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      double value = std::numeric_limits<double>::quiet_NaN();
      if (!cells_[i].empty() && !is_nan_text(cells_[i])) {
        const auto number = parse_number(cells_[i]);
        if (!number) lines_.fail(fmt::format("{}: `{}` is no number", out_.names[i], printable(cells_[i])));
        value = *number;
      }
      require_forward(static_cast<int>(i), value);
      out_.columns[i].push_back(value);
    }
  }

  void require_forward(int i_column, double value) const {
    if (i_column != i_frame_ && i_column != i_time_) return;
    const std::size_t i = static_cast<std::size_t>(i_column);
    if (std::isnan(value)) lines_.fail(fmt::format("{}: the cell is empty", out_.names[i]));
    if (!out_.columns[i].empty() && !(value > out_.columns[i].back())) {
      lines_.fail(fmt::format("{}: {} does not lie after {}", out_.names[i], value, out_.columns[i].back()));
    }
  }

  CsvLines lines_;
  SeriesFile out_;
  SeriesRoom room_;
  std::vector<std::string_view> cells_;
  int i_frame_ = -1, i_time_ = -1;
};

}  // namespace

int SeriesFile::column(const std::string& name) const noexcept {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

SeriesFile read_series_csv(const std::string& path) { return SeriesReader(path).read(); }

}  // namespace drivers
