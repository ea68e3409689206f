#pragma once

#include <cstdint>

#include "core/types/state_bytes.h"

namespace core {

// Maps time-stamped samples to the uniform grid that spectra need: cell = round((t - t0) * rate). A sample that is not
// one cell after its predecessor indicates lost samples (cells to be masked) or a surplus one. Stamps that jitter by
// less than half a cell keep their order; the jitter is measured and reported, but not corrected.
class TimeGrid {
 public:
  struct Placement {
    bool accepted = false;               // false: the cell is already occupied (repeated or backward stamp)
    std::uint64_t cell = 0;              // counted from the first sample
    std::uint64_t n_missing_before = 0;  // cells skipped between the previous sample and this one
  };

  explicit TimeGrid(double rate_hz) noexcept : rate_hz_(rate_hz) {}

  [[nodiscard]] Placement place(std::int64_t t_ns) noexcept;
  // restore() resumes at the last cell; the clock of the stamps has continued meanwhile.
  void save(StateWriter& out) const noexcept;
  void restore(StateReader& in) noexcept;  // sets `in` to not ok if the state is invalid

  [[nodiscard]] std::int64_t last_cell() const noexcept { return last_cell_; }
  [[nodiscard]] std::uint64_t n_refused() const noexcept { return n_refused_; }
  [[nodiscard]] double worst_jitter_cells() const noexcept { return worst_jitter_cells_; }

 private:
  double rate_hz_;
  bool started_ = false;
  std::int64_t t0_ns_ = 0;
  std::int64_t last_cell_ = 0;
  std::uint64_t n_refused_ = 0;
  double worst_jitter_cells_ = 0.0;
};

}  // namespace core
