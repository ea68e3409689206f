#include "drivers/storage/timed_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "drivers/storage/ascii.h"
#include "drivers/storage/csv_lines.h"
#include "drivers/storage/limits.h"
#include "drivers/storage/text_file.h"

namespace drivers {
namespace {

constexpr std::size_t kLeastRows = 16;
constexpr double kMostSteps = 3.0;  // a longer step is a gap
constexpr double kTimeSlack_s = 1e-6;

std::string_view bare(std::string_view cell) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!cell.empty() && blank(cell.front())) cell.remove_prefix(1);
  while (!cell.empty() && blank(cell.back())) cell.remove_suffix(1);
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
  return cell;
}

// Lower case, without the unit in brackets.
std::string plain_name(std::string_view cell) { return lower_ascii(bare(cell.substr(0, cell.find('(')))); }

class TimedReader {
 public:
  TimedReader(const std::string& path, const TimedColumnsWish& wish) : path_(path), wish_(wish), lines_(path) {
    columns_.resize(wish.columns.size());
  }

  [[nodiscard]] TimedColumns read() {
    read_header();
    require_rows();
    std::string_view line;
    while (!at_end_ && lines_.next(line)) {
      if (!bare(line).empty()) read_row(line);
    }
    if (n_rows_ == 0) lines_.fail("no row under the names of the columns");
    require_cover();
    return resample();
  }

 private:
  // Of a long file, the rows of the stretch are counted before memory is taken for them.
  void require_rows() const {
    if (lines_.count_lines() <= Limits::kFlightLogRows) return;
    CsvLines lines(path_);
    std::string_view line;
    std::vector<std::string_view> cells;
    std::optional<double> first;
    std::uint64_t n_rows = 0;
    while (lines.next(line)) {
      split_quoted_cells(line, cells);
      const auto unit = i_time_ < cells.size() ? parse_number(cells[i_time_]) : std::nullopt;
      if (!unit) continue;  // the names, or refused below
      if (!first) first = wish_.first_row_is_zero ? *unit : 0.0;
      const double t_s = wish_.offset_s + (*unit - *first) * wish_.seconds_per_unit;
      if (t_s < wish_.from_s - kTimeSlack_s || t_s > wish_.to_s + kTimeSlack_s) continue;
      if (++n_rows > Limits::kFlightLogRows)
        lines.fail(fmt::format("more than {} rows from {:g} to {:g} s are refused; choose a shorter stretch",
                               Limits::kFlightLogRows, wish_.from_s, wish_.to_s));
    }
  }

  void read_header() {
    std::string_view line;
    do {
      if (!lines_.next(line)) lines_.fail("no line with the names of the columns");
    } while (bare(line).empty());
    split_quoted_cells(line, cells_);
    for (const std::string_view cell : cells_) header_.emplace_back(cell);
    i_time_ = find(wish_.time);
    for (const ColumnWish& column : wish_.columns) i_column_.push_back(find(column));
  }

  [[nodiscard]] std::size_t find(const ColumnWish& column) const {
    for (const std::string& name : column.names) {
      for (std::size_t i = 0; i < header_.size(); ++i) {
        if (plain_name(header_[i]) == plain_name(name)) return i;
      }
    }
    std::string there;
    for (const std::string& name : header_) {
      if (!name.empty()) there += (there.empty() ? "" : ", ") + printable(name, 40);
    }
    lines_.fail(fmt::format("no column {} ({}); there are: {}", fmt::join(column.names, " or "), column.meaning,
                            printable(there, 1500)));
  }

  [[nodiscard]] double number(std::size_t i) const {
    const auto value = i < cells_.size() ? parse_number(cells_[i]) : std::nullopt;
    if (!value) {
      lines_.fail(fmt::format("{}: `{}` is no number", printable(header_[i]),
                              i < cells_.size() ? printable(cells_[i]) : "end of the line"));
    }
    return *value;
  }

  void read_row(std::string_view line) {
    split_quoted_cells(line, cells_);
    const double unit = number(i_time_);
    if (n_rows_++ == 0) {
      zero_ = wish_.first_row_is_zero ? unit : 0.0;
      first_s_ = wish_.offset_s + (unit - zero_) * wish_.seconds_per_unit;
    } else if (!(unit > last_unit_)) {
      lines_.fail(fmt::format("{}: {:.10g} does not lie after {:.10g}: the times go back", printable(header_[i_time_]),
                              unit, last_unit_));
    }
    last_unit_ = unit;
    last_s_ = wish_.offset_s + (unit - zero_) * wish_.seconds_per_unit;
    at_end_ = last_s_ > wish_.to_s + kTimeSlack_s;
    if (at_end_ || last_s_ < wish_.from_s - kTimeSlack_s) return;
    if (t_s_.size() >= 3) require_no_gap();
    t_s_.push_back(last_s_);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const double turn = wish_.columns[c].turn;
      const double value = number(i_column_[c]);
      const bool follows = turn > 0.0 && !columns_[c].empty();
      columns_[c].push_back(follows ? columns_[c].back() + std::remainder(value - columns_[c].back(), turn) : value);
    }
  }

  // The median of the steps so far, so that one long step at the beginning is not taken as normal.
  [[nodiscard]] double median_step() const {
    std::vector<double> steps;
    for (std::size_t i = 1; i < t_s_.size(); ++i) steps.push_back(t_s_[i] - t_s_[i - 1]);
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
  }

  void require_no_gap() {
    if (t_s_.size() <= kLeastRows) step_s_ = median_step();
    if (last_s_ - t_s_.back() > kMostSteps * step_s_) fail_gap(t_s_.back(), last_s_);
  }

  [[noreturn]] void fail_gap(double before_s, double after_s) const {
    lines_.fail(fmt::format(
        "no row for {:.6g} s, from {:.6g} to {:.6g} s of the flight (they come every {:.4g} s); choose a stretch "
        "before or after it",
        after_s - before_s, before_s, after_s, step_s_));
  }

  void require_cover() const {
    const double slack_s = t_s_.size() > 3 ? 1.5 * median_step() : 0.0;
    const bool covered =
        t_s_.size() > 3 && t_s_.front() <= wish_.from_s + slack_s && t_s_.back() >= wish_.to_s - slack_s;
    if (covered && t_s_.size() >= kLeastRows) return;
    if (covered || (first_s_ <= wish_.from_s && last_s_ >= wish_.to_s)) {
      throw FileError(fmt::format("{}: {} rows between {:.6g} and {:.6g} s; choose a stretch with at least {}", path_,
                                  t_s_.size(), wish_.from_s, wish_.to_s, kLeastRows));
    }
    const double from = std::max(first_s_, wish_.from_s), to = std::min(last_s_, wish_.to_s);
    throw FileError(fmt::format(
        "{}: holds {:.6g} to {:.6g} s of the flight, of the wanted {:.6g} to {:.6g} s {}; choose a stretch inside",
        path_, first_s_, last_s_, wish_.from_s, wish_.to_s,
        from < to ? fmt::format("only {:.6g} to {:.6g} s", from, to) : std::string("nothing")));
  }

  [[nodiscard]] TimedColumns resample() const {
    TimedColumns out;
    const double step_s = median_step();
    for (std::size_t i = 1; i < t_s_.size(); ++i) {  // again, because the first rows were compared with few steps
      if (t_s_[i] - t_s_[i - 1] > kMostSteps * step_s) {
        throw FileError(fmt::format(
            "{}: no row for {:.6g} s, from {:.6g} to {:.6g} s of the flight; choose a stretch before or after it",
            path_, t_s_[i] - t_s_[i - 1], t_s_[i - 1], t_s_[i]));
      }
    }
    out.rate_hz = 1.0 / step_s;
    out.from_s = t_s_.front();
    for (const std::size_t i : i_column_) out.names.push_back(header_[i]);
    out.columns.resize(columns_.size());
    std::size_t i = 0;
    const double slack_s = 1e-4 * step_s;
    for (std::size_t k = 0;; ++k) {
      const double t = t_s_.front() + static_cast<double>(k) * step_s;
      if (t > t_s_.back() + slack_s) break;
      while (i + 2 < t_s_.size() && t_s_[i + 1] <= t + slack_s) ++i;
      const double share = std::clamp((t - t_s_[i]) / (t_s_[i + 1] - t_s_[i]), 0.0, 1.0);
      const double x = share < 1e-4 ? 0.0 : share > 1.0 - 1e-4 ? 1.0 : share;
      for (std::size_t c = 0; c < columns_.size(); ++c)
        out.columns[c].push_back((1.0 - x) * columns_[c][i] + x * columns_[c][i + 1]);
    }
    return out;
  }

  std::string path_;
  const TimedColumnsWish& wish_;
  CsvLines lines_;
  std::vector<std::string_view> cells_;
  std::vector<std::string> header_;
  std::size_t i_time_ = 0;
  std::vector<std::size_t> i_column_;
  std::size_t n_rows_ = 0;
  double zero_ = 0.0, last_unit_ = 0.0, first_s_ = 0.0, last_s_ = 0.0, step_s_ = 0.0;
  bool at_end_ = false;
  std::vector<double> t_s_;
  std::vector<std::vector<double>> columns_;
};

}  // namespace

void split_quoted_cells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  std::size_t begin = 0;
  bool quoted = false;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != ',')) continue;
    cells.push_back(bare(line.substr(begin, i - begin)));
    begin = i + 1;
  }
}

TimedColumns read_timed_columns(const std::string& path, const TimedColumnsWish& wish) {
  if (!std::isfinite(wish.from_s) || !std::isfinite(wish.to_s) || !std::isfinite(wish.offset_s) ||
      !(wish.from_s < wish.to_s)) {
    throw std::invalid_argument(
        fmt::format("{}: stretch from {:g} to {:g} s, first row at {:g} s; give finite seconds, "
                    "the second after the first",
                    path, wish.from_s, wish.to_s, wish.offset_s));
  }
  return TimedReader(path, wish).read();
}

}  // namespace drivers
