#include "firmware_app/report/plot/binned_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace app {

void BinnedSeries::join(Bin& into, const Bin& other) noexcept {
  if (other.n == 0) return;
  if (into.n == 0) {
    into = other;
    return;
  }
  if (other.low < into.low) into.low = other.low, into.at_low = other.at_low;
  if (other.high > into.high) into.high = other.high, into.at_high = other.at_high;
  into.sum += other.sum;
  into.n += other.n;
}

void BinnedSeries::halve() noexcept {
  for (std::size_t i = 0; i < kBins / 2; ++i) {
    Bin both = bins_[2 * i];
    join(both, bins_[2 * i + 1]);
    bins_[i] = both;
  }
  std::fill(bins_.begin() + kBins / 2, bins_.end(), Bin{});
  cells_per_bin_ *= 2;
}

void BinnedSeries::add(std::uint64_t i_cell, double value) noexcept {
  if (!std::isfinite(value)) return;
  // At most some fifty times in any run, because cells_per_bin_ doubles each time.
  while (i_cell / cells_per_bin_ >= kBins) halve();
  join(bins_[i_cell / cells_per_bin_], {value, value, value, i_cell, i_cell, 1});
  n_cells_ = i_cell + 1;
  if (n_ == 0) offset_ = low_ = high_ = value;
  low_ = std::min(low_, value), high_ = std::max(high_, value);
  sum_ += value - offset_, sum_squares_ += (value - offset_) * (value - offset_);
  ++n_;
}

std::vector<PlotPoint> BinnedSeries::curve(double cell_s) const {
  std::vector<PlotPoint> out;
  for (std::size_t i = 0; i < kBins && i * cells_per_bin_ < n_cells_; ++i) {
    const Bin& bin = bins_[i];
    const auto at = [&](std::uint64_t i_cell, double value) {
      out.push_back({static_cast<double>(i_cell) * cell_s, value});
    };
    if (bin.n == 0) {
      at(i * cells_per_bin_, std::numeric_limits<double>::quiet_NaN());
    } else if (bin.at_low == bin.at_high) {
      at(bin.at_low, bin.low);
    } else {
      const bool low_first = bin.at_low < bin.at_high;
      at(low_first ? bin.at_low : bin.at_high, low_first ? bin.low : bin.high);
      at(low_first ? bin.at_high : bin.at_low, low_first ? bin.high : bin.low);
    }
  }
  return out;
}

std::vector<PlotPoint> BinnedSeries::means(double cell_s) const {
  std::vector<PlotPoint> out;
  const auto width = static_cast<double>(cells_per_bin_);
  for (std::size_t i = 0; i < kBins && i * cells_per_bin_ < n_cells_; ++i) {
    const double middle = (static_cast<double>(i) * width + (width - 1.0) / 2.0) * cell_s;
    const Bin& bin = bins_[i];
    out.push_back(
        {middle, bin.n == 0 ? std::numeric_limits<double>::quiet_NaN() : bin.sum / static_cast<double>(bin.n)});
  }
  return out;
}

double BinnedSeries::mean() const noexcept { return n_ == 0 ? 0.0 : offset_ + sum_ / static_cast<double>(n_); }

double BinnedSeries::rms() const noexcept {
  if (n_ == 0) return 0.0;
  const auto n = static_cast<double>(n_);
  return std::sqrt(std::max(0.0, sum_squares_ / n - sum_ / n * (sum_ / n)));
}

}  // namespace app
