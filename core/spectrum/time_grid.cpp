#include "core/spectrum/time_grid.h"

#include <algorithm>
#include <cmath>

namespace core {

TimeGrid::Placement TimeGrid::place(std::int64_t t_ns) noexcept {
  if (!started_) {
    started_ = true;
    t0_ns_ = t_ns;
    return {true, 0, 0};
  }
  if (t_ns < t0_ns_) {
    ++n_refused_;
    return {};
  }
  // Unsigned: the step between two stamps from the ends of int64 does not overflow.
  const auto step_ns = static_cast<std::uint64_t>(t_ns) - static_cast<std::uint64_t>(t0_ns_);
  const double position = static_cast<double>(step_ns) * 1e-9 * rate_hz_;
  const double nearest = std::nearbyint(position);
  const auto cell = static_cast<std::int64_t>(nearest);
  if (cell <= last_cell_) {
    ++n_refused_;
    return {};
  }
  worst_jitter_cells_ = std::max(worst_jitter_cells_, std::abs(position - nearest));
  const auto n_missing = static_cast<std::uint64_t>(cell - last_cell_ - 1);
  last_cell_ = cell;
  return {true, static_cast<std::uint64_t>(cell), n_missing};
}

void TimeGrid::save(StateWriter& out) const noexcept {
  out.value(started_);
  out.value(t0_ns_);
  out.value(last_cell_);
}

void TimeGrid::restore(StateReader& in) noexcept {
  in.value(started_);
  in.value(t0_ns_);
  in.value(last_cell_);
  if (last_cell_ >= 0) return;
  last_cell_ = 0;
  in.fail();
}

}  // namespace core
