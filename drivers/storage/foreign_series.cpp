#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "drivers/storage/csv.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/series_format.h"
#include "drivers/storage/series_room.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

constexpr std::uint64_t kLinesPerReport = 200'000;
constexpr std::size_t kMaxColumns = Limits::kColumns;
constexpr std::string_view kLabviewFirst = "LabVIEW Measurement";
constexpr std::string_view kLabviewEnd = "***End_of_Header***";

class ForeignReader {
 public:
  ForeignReader(const std::string& path, const ForeignFormat& options) : lines_(path), options_(options) {}

  [[nodiscard]] SeriesFile read() {
    read_head();
    std::string_view line;
    while (next(line)) {
      // In a table of one column an empty line is a missing value.
      if (is_blank(line) && out_.names.size() > 1) continue;
      read_row(line);
    }
    if (out_.columns.empty()) lines_.fail("no line of numbers in the file");
    return std::move(out_);
  }

 private:
  static bool is_blank(std::string_view line) { return line.find_first_not_of(" \t") == std::string_view::npos; }

  bool next(std::string_view& line) {
    if (!lines_.next(line)) return false;
    if (++n_lines_ % kLinesPerReport == 0 && options_.progress) options_.progress(n_lines_);
    return true;
  }

  // Everything up to and including the first line of numbers. The line above it contains the names.
  void read_head() {
    std::string names;
    std::string_view line;
    while (next(line)) {
      if (is_blank(line)) continue;
      if (n_lines_ == 1 && line.starts_with(kLabviewFirst)) {
        names = read_labview_head();
        continue;
      }
      if (line.starts_with('#') || line.starts_with('%')) {
        note_comment(line);
        continue;
      }
      const auto format = detect_cell_format(line);
      if (!format) {
        if (is_gap(line)) continue;  // before the first sample
        if (!names.empty() || options_.no_names) refuse_line(line);
        names = line;
        continue;
      }
      cell_format_ = *format;
      set_columns(names, line);
      return read_row(line);
    }
    lines_.fail(names.empty() ? "the file holds no numbers" : "no line of numbers under the names");
  }

  [[noreturn]] void refuse_line(std::string_view line) const {
    lines_.fail(
        fmt::format("`{}` is neither a line of numbers nor, on the first line, names of columns; put # before "
                    "lines of text",
                    printable(line)));
  }

  void note_comment(std::string_view line) {
    std::string text(line);
    text.front() = '#';
    std::string key, value;
    if (split_comment(text, key, value)) room_.keep_comment(lines_, key, value, out_);
  }

  // Up to the second end mark; returns the line after it: names, with a column X_Value and one for comments. Cells
  // of the head are separated like those of the table: by tabs or, in a line without tabs, by commas.
  std::string read_labview_head() {
    std::string_view line;
    int n_ends = 0;
    std::vector<std::string_view> cells;
    while (next(line)) {
      if (line.starts_with(kLabviewEnd) && ++n_ends == 2) break;
      split_series_cells(line, line.find('\t') == std::string_view::npos ? ',' : '\t', cells);
      const bool has_value = cells.size() > 1 && !cells[1].empty();
      if (has_value && cells[0] == "X_Columns" && cells[1] != "No" && cells[1] != "One")
        lines_.fail("X_Columns Multi: a column of times for every channel is not read; export with one or none");
      if (cells[0] == "Y_Unit_Label") labview_units_.assign(cells.begin() + 1, cells.end());
      if (!has_value || cells[0] != "Delta_X") continue;
      const auto step = parse_series_number(cells[1], cells[1].find(',') != std::string_view::npos);
      if (step && *step > 0.0) out_.rate_hz = 1.0 / *step;
    }
    if (n_ends < 2 || !next(line)) lines_.fail("the head of a LabVIEW measurement file does not end");
    is_labview_ = true;
    return std::string(line);
  }

  static bool is_gap(std::string_view line) {
    std::vector<std::string_view> cells;
    for (const char separator : {'\t', ';', ',', ' '}) {
      split_series_cells(line, separator, cells);
      if (std::all_of(cells.begin(), cells.end(), is_missing_cell)) return true;
    }
    return false;
  }

  void set_columns(const std::string& names, std::string_view line) {
    split_series_cells(line, cell_format_.separator, cells_);
    if (cells_.size() > 1 && cells_.back().empty()) cells_.pop_back();  // a separator at the end of the line
    const std::size_t n_cells = cells_.size();
    if (n_cells > kMaxColumns) lines_.fail(fmt::format("{} columns; at most {}", n_cells, kMaxColumns));
    out_.has_names = !names.empty();
    if (names.empty()) {
      for (std::size_t i = 0; i < n_cells; ++i) out_.names.push_back(fmt::format("c{}", i + 1));
    } else {
      name_columns(names, n_cells);
    }
    out_.units.resize(out_.names.size());
    for (std::size_t i = 1; is_labview_ && i < out_.units.size() && i <= labview_units_.size(); ++i)
      out_.units[i] = labview_units_[i - 1];
    out_.columns.resize(out_.names.size());
    room_.reserve(lines_, out_);
    i_frame_ = out_.column("frame");
    i_time_ = out_.column("t_s");
  }

  void name_columns(const std::string& names, std::size_t n_cells) {
    std::vector<std::string_view> cells;
    split_series_cells(names, cell_format_.separator, cells);
    // A separator at the end, or LabVIEW's column of comments, which rows omit.
    if (cells.size() == n_cells + 1 && (is_labview_ || cells.back().empty())) cells.pop_back();
    if (cells.size() != n_cells) {
      lines_.fail(fmt::format("{} cells under {} names (`{}`)", n_cells, cells.size(), printable(names)));
    }
    for (std::string_view cell : cells) {
      if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
      if (parse_series_number(cell, cell_format_.decimal_comma))
        lines_.fail(fmt::format("the line above is neither numbers nor names: `{}`", printable(names)));
      out_.units.push_back(unit_of_name(cell));
      add_name(without_unit(cell));
    }
  }

  void add_name(std::string_view cell) {
    if (cell.empty() || cell.size() > 64) lines_.fail("a column's name is empty or longer than 64 characters");
    try {
      require_text(cell, "");
    } catch (const FileError&) {
      lines_.fail("a column's name is no UTF-8 text");
    }
    if (out_.column(std::string(cell)) >= 0) lines_.fail(fmt::format("column `{}` appears twice", printable(cell)));
    out_.names.emplace_back(cell);
  }

  void read_row(std::string_view line) {
    split_series_cells(line, cell_format_.separator, cells_);
    // An empty cell after the last separator does not count.
    if (cells_.size() == out_.names.size() + 1 && cells_.back().empty()) cells_.pop_back();
    if (cells_.size() != out_.names.size() && !(out_.names.size() == 1 && cells_.empty())) {
      lines_.fail(fmt::format("{} cells instead of {}; is the file cut off?", cells_.size(), out_.names.size()));
    }
    cells_.resize(out_.names.size());
    room_.require(lines_, out_);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      const double value = cell_value(i);
      require_forward(static_cast<int>(i), value);
      out_.columns[i].push_back(value);
    }
  }

  double cell_value(std::size_t i) {
    const std::string_view cell = cells_[i];
    if (is_missing_cell(cell)) {
      if (cell.find_first_of("fF") != std::string_view::npos) ++out_.n_not_finite;
      return std::numeric_limits<double>::quiet_NaN();
    }
    const auto number = parse_series_number(cell, cell_format_.decimal_comma);
    if (!number) lines_.fail(fmt::format("{}: `{}` is no number", out_.names[i], printable(cell)));
    return *number;
  }

  void require_forward(int i_column, double value) const {
    if (i_column != i_frame_ && i_column != i_time_) return;
    const auto i = static_cast<std::size_t>(i_column);
    if (std::isnan(value)) lines_.fail(fmt::format("{}: the cell is empty", out_.names[i]));
    if (!out_.columns[i].empty() && !(value > out_.columns[i].back())) {
      lines_.fail(fmt::format("{}: {} does not lie after {}", out_.names[i], value, out_.columns[i].back()));
    }
  }

  CsvLines lines_;
  const ForeignFormat& options_;
  SeriesFile out_;
  SeriesRoom room_;
  CellFormat cell_format_;
  bool is_labview_ = false;
  std::vector<std::string> labview_units_;
  std::vector<std::string_view> cells_;
  std::uint64_t n_lines_ = 0;
  int i_frame_ = -1, i_time_ = -1;
};

}  // namespace

SeriesFile read_foreign_series(const std::string& path, const ForeignFormat& format) {
  return ForeignReader(path, format).read();
}

}  // namespace drivers
