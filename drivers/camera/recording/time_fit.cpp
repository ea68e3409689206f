#include "drivers/camera/recording/time_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace drivers {

namespace {

struct Grid {
  double period_s = 0.0, phase_s = 0.0, rms_s = 0.0, worst_s = 0.0;
  std::vector<double> cells;
  [[nodiscard]] double relative_rms() const noexcept { return period_s > 0.0 ? rms_s / period_s : 1.0; }
};

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> differences(std::span<const double> t_s) {
  std::vector<double> out;
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    if (t_s[i] > t_s[i - 1]) out.push_back(t_s[i] - t_s[i - 1]);
  }
  return out;
}

// Cell by cell; the grid is moved half-way to every time, so that a period with some per cent error does not
// accumulate.
std::vector<double> counted_cells(std::span<const double> t_s, double period_s) {
  constexpr double kPull = 0.5;
  std::vector<double> cells(t_s.size(), 0.0);
  double reference_s = t_s.empty() ? 0.0 : t_s[0];
  for (std::size_t i = 1; i < t_s.size(); ++i) {
    const double steps = std::nearbyint((t_s[i] - reference_s) / period_s);
    cells[i] = cells[i - 1] + steps;
    reference_s += steps * period_s;
    reference_s += kPull * (t_s[i] - reference_s);
  }
  return cells;
}

void fit_line(std::span<const double> t_s, Grid& grid) {
  const auto n = static_cast<double>(t_s.size());
  double mean_k = 0.0, mean_t = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) mean_k += grid.cells[i] / n, mean_t += t_s[i] / n;
  double kk = 0.0, kt = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    kk += (grid.cells[i] - mean_k) * (grid.cells[i] - mean_k);
    kt += (grid.cells[i] - mean_k) * (t_s[i] - mean_t);
  }
  if (kk > 0.0 && kt > 0.0) grid.period_s = kt / kk;
  grid.phase_s = mean_t - grid.period_s * mean_k;
}

void measure(std::span<const double> t_s, Grid& grid) {
  double squares = 0.0;
  grid.worst_s = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    const double off_s = t_s[i] - grid.phase_s - grid.period_s * grid.cells[i];
    squares += off_s * off_s;
    grid.worst_s = std::max(grid.worst_s, std::abs(off_s));
  }
  grid.rms_s = std::sqrt(squares / static_cast<double>(t_s.size()));
}

void assign_cells(std::span<const double> t_s, Grid& grid) {
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    grid.cells[i] = std::nearbyint((t_s[i] - grid.phase_s) / grid.period_s);
    if (i > 0) grid.cells[i] = std::max(grid.cells[i], grid.cells[i - 1]);
  }
}

Grid grid_of(std::span<const double> t_s, double period_s) {
  constexpr int kRounds = 4;
  Grid grid;
  grid.period_s = period_s;
  grid.cells = counted_cells(t_s, period_s);
  for (int round = 0; round < kRounds; ++round) {
    fit_line(t_s, grid);
    const std::vector<double> before = grid.cells;
    assign_cells(t_s, grid);
    if (before == grid.cells) break;
  }
  measure(t_s, grid);
  return grid;
}

// The coarsest grid on which the times lie; if there is none, the one with the smallest deviation.
Grid best_grid(std::span<const double> t_s, double median_s, std::span<const double> stated_hz) {
  constexpr double kLiesOn = 0.03, kStrays = 0.12;  // rms over the period; the second: about that of the median
  Grid best = grid_of(t_s, median_s);
  if (best.relative_rms() < kStrays) return best;
  std::vector<double> finer{median_s / 2.0, median_s / 3.0};
  for (const double rate_hz : stated_hz) {
    if (rate_hz > 0.0 && 1.0 / rate_hz > 0.3 * median_s && 1.0 / rate_hz < 2.0 * median_s)
      finer.push_back(1.0 / rate_hz);
  }
  std::sort(finer.begin(), finer.end(), std::greater<>());
  for (const double period_s : finer) {
    Grid grid = grid_of(t_s, period_s);
    if (grid.relative_rms() < kLiesOn) return grid;
  }
  return best;
}

// Rates of blocks of frames, each fitted separately. A block in which every second frame is missing agrees.
std::optional<RateChange> change_of_rate(std::span<const double> t_s) {
  constexpr std::size_t kBlocks = 8, kFewest = 16, kMost = 128;
  constexpr double kDiffers = 0.005, kSigmas = 6.0;
  const std::size_t length = std::clamp(t_s.size() / kBlocks, kFewest, kMost);
  if (t_s.size() < 4 * kFewest) return {};
  struct Block {
    double period_s, error;  // error: relative, one standard deviation
    bool differs = false;
  };
  std::vector<Block> blocks;
  std::vector<double> periods;
  for (std::size_t at = 0; at + length <= t_s.size(); at += length) {
    const auto part = t_s.subspan(at, length);
    const double median_s = median_of(differences(part));
    const Grid grid = median_s > 0.0 ? grid_of(part, median_s) : Grid{};
    blocks.push_back({grid.period_s, grid.relative_rms() * std::sqrt(12.0 / static_cast<double>(length)) /
                                         static_cast<double>(length)});
    periods.push_back(grid.period_s);
  }
  const double usual_s = median_of(periods);
  std::size_t first = blocks.size(), last = 0, n_differ = 0;
  for (std::size_t b = 0; b < blocks.size() && usual_s > 0.0; ++b) {
    const double ratio = std::max(blocks[b].period_s / usual_s, 1e-9);
    const double above = std::max(ratio, 1.0 / ratio);
    blocks[b].differs = std::abs(above / std::nearbyint(above) - 1.0) > std::max(kDiffers, kSigmas * blocks[b].error);
    if (!blocks[b].differs) continue;
    first = std::min(first, b), last = b, ++n_differ;
  }
  if (n_differ < 2 || n_differ * kBlocks < blocks.size()) return {};
  const bool at_the_beginning = first == 0;
  const std::size_t edge = at_the_beginning ? last + 1 : first;
  if (edge >= blocks.size()) return RateChange{1.0 / blocks.front().period_s, 1.0 / blocks.back().period_s, 0.0};
  return RateChange{1.0 / blocks.front().period_s, 1.0 / blocks.back().period_s, t_s[edge * length]};
}

// The stated rate that agrees within `resolution`, otherwise the grid's own.
double agreed_rate_hz(std::span<const double> stated_hz, double resolution, const Grid& grid) {
  double nearest = resolution;
  double agreed_hz = 1.0 / grid.period_s;
  for (const double rate_hz : stated_hz) {
    if (!(rate_hz > 0.0) || !(std::abs(grid.period_s * rate_hz - 1.0) <= nearest)) continue;
    nearest = std::abs(grid.period_s * rate_hz - 1.0), agreed_hz = rate_hz;
  }
  return agreed_hz;
}

void count_gaps(TimeFit& fit) {
  for (std::size_t i = 1; i < fit.cells.size(); ++i) {
    const std::uint64_t step = fit.cells[i] - fit.cells[i - 1];
    if (step < 2) continue;
    fit.n_lost += step - 1;
    ++fit.n_gaps;
    fit.longest_gap_s = std::max(fit.longest_gap_s, static_cast<double>(step - 1) * fit.period_s);
  }
}

}  // namespace

TimeFit fit_times(std::span<const std::int64_t> times_ns, double tick_s, std::span<const double> stated_hz) {
  TimeFit out;
  std::vector<double> t_s;
  t_s.reserve(times_ns.size());
  for (const std::int64_t t_ns : times_ns) t_s.push_back(static_cast<double>(t_ns - times_ns.front()) * 1e-9);
  const double median_s = median_of(differences(t_s));
  if (!(median_s > 0.0)) return out;
  out.change = change_of_rate(t_s);
  Grid grid = best_grid(t_s, median_s, stated_hz);
  constexpr double kClock = 20e-6;  // relative error of a camera's crystal
  out.rate_hz = agreed_rate_hz(stated_hz, std::max(kClock, 1.5 * tick_s / t_s.back()), grid);
  out.period_s = 1.0 / out.rate_hz;
  out.phase_s = grid.phase_s + grid.period_s * grid.cells.front();
  out.jitter_s = grid.rms_s, out.worst_s = grid.worst_s;
  out.is_even = grid.worst_s <= std::max(1.01 * tick_s, 0.02 * grid.period_s);
  out.cells.reserve(t_s.size());
  for (const double cell : grid.cells) out.cells.push_back(static_cast<std::uint64_t>(cell - grid.cells.front()));
  count_gaps(out);
  return out;
}

}  // namespace drivers
