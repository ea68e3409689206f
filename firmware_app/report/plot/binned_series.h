#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "firmware_app/report/plot/svg_document.h"

namespace app {

// A series of any length in fixed memory: equal stretches of time with their lowest, highest and mean value. When every
// stretch is in use, neighbours are merged and each becomes twice as long. Nothing is allocated after construction. The
// time of a value is the number of its cell; a cell without a value was not seen.
class BinnedSeries {
 public:
  static constexpr std::size_t kBins = 1024;

  BinnedSeries() : bins_(kBins) {}

  // `i_cell` must not decrease; a value that is not finite counts as not seen.
  void add(std::uint64_t i_cell, double value) noexcept;

  // Lowest and highest value of every stretch, in order of time, x in seconds. A stretch without a value is a gap.
  [[nodiscard]] std::vector<PlotPoint> curve(double cell_s) const;
  [[nodiscard]] std::vector<PlotPoint> means(double cell_s) const;  // at the middle of every stretch

  [[nodiscard]] bool empty() const noexcept { return n_ == 0; }
  [[nodiscard]] std::uint64_t n_values() const noexcept { return n_; }
  [[nodiscard]] double low() const noexcept { return low_; }  // of all values; 0 if there are none
  [[nodiscard]] double high() const noexcept { return high_; }
  [[nodiscard]] double mean() const noexcept;
  [[nodiscard]] double rms() const noexcept;  // about the mean

 private:
  struct Bin {
    double low = 0.0, high = 0.0, sum = 0.0;
    std::uint64_t at_low = 0, at_high = 0, n = 0;
  };
  static void join(Bin& into, const Bin& other) noexcept;
  void halve() noexcept;

  std::vector<Bin> bins_;
  std::uint64_t cells_per_bin_ = 1;
  std::uint64_t n_cells_ = 0;  // up to the last cell with a value
  double offset_ = 0.0;        // the first value: keeps the sums small
  double sum_ = 0.0, sum_squares_ = 0.0, low_ = 0.0, high_ = 0.0;
  std::uint64_t n_ = 0;
};

}  // namespace app
