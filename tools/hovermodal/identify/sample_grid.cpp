#include "tools/hovermodal/identify/sample_grid.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace tools {

namespace {

constexpr double kLargestDisagreement = 0.01;  // between two statements of the rate
constexpr double kMostCellsPerRow = 20.0;

using Column = std::vector<double>;

bool goes_forward(const Column& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || (i > 0 && !(values[i] > values[i - 1]))) return false;
  }
  return values.size() > 1;
}

// Steps are rounded to whole multiples of the median one, so that gaps and rounded times do not change the rate.
double measured_rate_hz(const Column& t) {
  std::vector<double> steps(t.size() - 1);
  for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = t[i + 1] - t[i];
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double median = *middle;
  const double cells = std::accumulate(steps.begin(), steps.end(), 0.0,
                                       [&](double sum, double step) { return sum + std::round(step / median); });
  return cells / (t.back() - t.front());
}

void require_whole(const Column& frames, const std::string& path) {
  const auto other = std::find_if(frames.begin(), frames.end(), [](double x) { return x != std::floor(x); });
  if (other == frames.end()) return;
  throw std::invalid_argument(
      fmt::format("{}: frame: {:.12g} is no number of a frame; call the column t_s if it holds seconds, else delete it",
                  path, *other));
}

// Assigns rows to cells of `step`; of several rows in one cell the first is used.
void place(const Column& positions, double cells_per_unit, const std::string& path, SampleGrid& grid) {
  const double span = (positions.back() - positions.front()) * cells_per_unit;
  if (span > kMostCellsPerRow * static_cast<double>(positions.size()) + 1000.0) {
    throw std::invalid_argument(
        fmt::format("{}: {} rows span {:.0f} samples: is there a gap of hours, or a wrong --rate-hz?", path,
                    positions.size(), span));
  }
  std::int64_t last = -1;
  std::size_t n_refused = 0;
  for (const double position : positions) {
    const std::int64_t cell = std::llround((position - positions.front()) * cells_per_unit);
    if (cell <= last) ++n_refused;
    grid.cell_of_row.push_back(cell > last ? cell : -1);
    last = std::max(last, cell);
  }
  grid.n_cells = static_cast<std::size_t>(last + 1);
  const std::size_t n_missing = grid.n_cells + n_refused - positions.size();
  if (n_missing > 0)
    grid.remarks.push_back(fmt::format("{} of {} samples are missing from the rows", n_missing, grid.n_cells));
  if (n_refused > 0) grid.remarks.push_back(fmt::format("{} rows are not used: another has their time", n_refused));
}

void require_agreement(double said_hz, double file_hz, const char* of_file, const std::string& path) {
  if (said_hz <= 0.0 || std::abs(file_hz / said_hz - 1.0) <= kLargestDisagreement) return;
  throw std::invalid_argument(
      fmt::format("{}: --rate-hz {:g} disagrees with the file's {}, {:.6g} Hz", path, said_hz, of_file, file_hz));
}

std::string lower_without_blanks(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (c != ' ') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return out;
}

}  // namespace

int time_column(const drivers::SeriesFile& file) {
  // x_value: LabVIEW's, with more digits than Delta_X in its head.
  constexpr std::array<std::string_view, 10> kNames{"t_s",     "t",       "time",    "time_s", "t[s]",
                                                    "time[s]", "time(s)", "seconds", "t(s)",   "x_value"};
  for (std::size_t c = 0; c < file.names.size(); ++c) {
    const std::string name = lower_without_blanks(file.names[c]);
    if (std::find(kNames.begin(), kNames.end(), name) != kNames.end()) return static_cast<int>(c);
  }
  return -1;
}

SampleGrid sample_grid(const drivers::SeriesFile& file, double rate_hz, const std::string& path) {
  SampleGrid grid;
  const int i_time = time_column(file);
  if (file.columns.front().size() < 2) throw std::invalid_argument(path + ": fewer than two samples");
  if (i_time >= 0) {
    const Column& t = file.columns[static_cast<std::size_t>(i_time)];
    if (goes_forward(t)) {
      const double measured_hz = measured_rate_hz(t);
      require_agreement(rate_hz, measured_hz, "times", path);
      place(t, measured_hz, path, grid);
      grid.rate_hz = rate_hz > 0.0 ? rate_hz : measured_hz;
      return grid;
    }
    const bool is_empty = std::all_of(t.begin(), t.end(), [](double x) { return std::isnan(x); });
    if (!is_empty)
      grid.remarks.push_back(fmt::format("column {} is not used: its times do not go forward",
                                         file.names[static_cast<std::size_t>(i_time)]));
  }
  if (file.rate_hz) require_agreement(rate_hz, *file.rate_hz, "head", path);
  grid.rate_hz = rate_hz > 0.0 ? rate_hz : file.rate_hz.value_or(0.0);
  if (!(grid.rate_hz > 0.0))
    throw std::invalid_argument(path + ": no column t_s with times in seconds: say --rate-hz HZ");
  const int i_frame = file.column("frame");
  if (i_frame >= 0) {
    const Column& frames = file.columns[static_cast<std::size_t>(i_frame)];
    require_whole(frames, path);
    place(frames, 1.0, path, grid);
    return grid;
  }
  grid.n_cells = file.columns.front().size();
  grid.cell_of_row.resize(grid.n_cells);
  std::iota(grid.cell_of_row.begin(), grid.cell_of_row.end(), std::int64_t{0});
  return grid;
}

}  // namespace tools
