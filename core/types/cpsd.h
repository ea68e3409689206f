#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "core/types/segment_spectra.h"

namespace core {

// Weight of the segments in a sum: with forgetting, older segments weigh less; otherwise each weighs one.
struct SegmentWeight {
  double sum = 0.0, squares = 0.0;

  void add_one() noexcept { sum += 1.0, squares += 1.0; }
  void fade(double factor) noexcept { sum *= factor, squares *= factor * factor; }
  void join(const SegmentWeight& other) noexcept { sum += other.sum, squares += other.squares; }
  // Number of equal segments with the same variance.
  [[nodiscard]] double effective() const noexcept { return squares > 0.0 ? sum * sum / squares : 0.0; }
};

// Sums of one of several contiguous parts of the record, from which standard deviations are computed.
struct CpsdBlock {
  std::uint64_t n_segments = 0;
  SegmentWeight weight;
  std::vector<std::complex<double>> data_sum, mask_sum;  // as in CpsdSums
};

// Sums of a Welch estimate, not yet divided. bins x pairs; a pair (i <= j) is at i * n - i (i - 1) / 2 + (j - i). Bin k
// is at k * rate_hz / n_fft. `mask_sum` is the same for the seen/missing masks: dividing the two inverse transforms
// removes the window and the losses in one step (core/spectrum/METHOD.md).
struct CpsdSums {
  int n_channels = 0;
  int n_fft = 0;
  double rate_hz = 0.0;
  std::uint64_t n_segments = 0;
  SegmentWeight weight;                        // of those segments: densities are divided by its sum
  std::uint64_t n_samples = 0;                 // stream position: grid cells pushed, seen or missing
  std::uint64_t n_missing = 0;                 // channel samples masked out
  std::vector<std::uint64_t> n_outlying;       // per channel: masked samples rejected by the outlier gate; may be empty
  double window_power = 0.0;                   // sum of squared window values of one full segment
  std::vector<std::complex<double>> data_sum;  // mm^2
  std::vector<std::complex<double>> mask_sum;  // dimensionless
  std::vector<CpsdBlock> blocks;               // in order; their sum is the sums above; may be empty
  std::size_t n_blocks = 0;                    // number of blocks in use
  SegmentSpectra segments;                     // the newest segments of the sums; may keep none

  [[nodiscard]] int n_bins() const noexcept { return n_fft / 2 + 1; }
  [[nodiscard]] int n_pairs() const noexcept { return n_channels * (n_channels + 1) / 2; }
  // Number of samples within the estimate's memory: all of them, unless it forgets.
  [[nodiscard]] double n_remembered() const noexcept {
    const double share = n_segments > 0 ? weight.effective() / static_cast<double>(n_segments) : 1.0;
    return share * static_cast<double>(n_samples);
  }
  // Copies everything except the blocks and the segments, for the first channels.
  void copy_totals(const CpsdSums& other, int n_first) {
    n_channels = n_first, n_fft = other.n_fft, rate_hz = other.rate_hz;
    n_segments = other.n_segments, n_samples = other.n_samples, n_missing = other.n_missing;
    window_power = other.window_power, weight = other.weight;
    n_outlying = other.n_outlying;
    n_outlying.resize(n_outlying.empty() ? 0 : static_cast<std::size_t>(n_first), 0);
    copy_pairs(other.data_sum, other.n_channels, data_sum);
    copy_pairs(other.mask_sum, other.n_channels, mask_sum);
    blocks.clear(), n_blocks = 0, segments = {};
  }
  [[nodiscard]] static int pair_index(int i, int j, int n) noexcept { return i * n - i * (i - 1) / 2 + (j - i); }

 private:
  void copy_pairs(const std::vector<std::complex<double>>& from, int n_all,
                  std::vector<std::complex<double>>& to) const {
    const auto per_bin = static_cast<std::size_t>(n_all * (n_all + 1) / 2);
    to.clear();
    to.reserve(per_bin > 0 ? from.size() / per_bin * static_cast<std::size_t>(n_pairs()) : 0);
    for (std::size_t first = 0; first + per_bin <= from.size() && per_bin > 0; first += per_bin) {
      for (int i = 0; i < n_channels; ++i) {
        for (int j = i; j < n_channels; ++j)
          to.push_back(from[first + static_cast<std::size_t>(pair_index(i, j, n_all))]);
      }
    }
  }
};

}  // namespace core
