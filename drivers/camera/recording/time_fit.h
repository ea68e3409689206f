#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace drivers {

struct RateChange {
  double before_hz = 0.0, after_hz = 0.0, at_s = 0.0;
};

// The uniform grid that the frame times of a recording lie on: t = phase + period * cell, cells whole numbers.
struct TimeFit {
  double rate_hz = 0.0;  // 0: fewer than two different times; all other fields are then meaningless
  double period_s = 0.0;
  double phase_s = 0.0;              // of cell 0, relative to the first time
  std::vector<std::uint64_t> cells;  // of every frame, starting at 0, never decreasing; equal: two frames in one period
  double jitter_s = 0.0;             // rms distance of the times from their cells
  double worst_s = 0.0;
  bool is_even = false;      // the times differ from the grid by no more than their own resolution or 2 % of a period
  std::uint64_t n_lost = 0;  // cells without a frame between the first and the last
  std::uint64_t n_gaps = 0;  // runs of such cells
  double longest_gap_s = 0.0;
  std::optional<RateChange> change;  // parts of the recording have different rates: no single grid fits
};

// The period is the robust median of the differences, refined by least squares over all times: rounding to whole
// milliseconds (Matroska), lost frames and single outliers have no influence. If one of `stated_hz` (the container's
// rates) agrees within the resolution of the times, it is used exactly, so that a clean clip has its nominal rate to
// the last bit. More than half of the frames may be lost if the others lie on a finer grid. times_ns: increasing or
// equal.
[[nodiscard]] TimeFit fit_times(std::span<const std::int64_t> times_ns, double tick_s,
                                std::span<const double> stated_hz);

}  // namespace drivers
