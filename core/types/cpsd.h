#pragma once

#include <complex>
#include <cstdint>
#include <vector>

namespace core {

// Sums of a Welch estimate, not yet divided. bins x pairs; a pair (i <= j) stands at i * n - i (i - 1) / 2 + (j - i).
// Bin k lies at k * rate_hz / n_fft. `mask_sum` is the same for the seen/missing masks: dividing the two inverse
// transforms removes the window and the losses in one step (ARCHITECTURE.md).
struct CpsdSums {
  int n_channels = 0;
  int n_fft = 0;
  double rate_hz = 0.0;
  std::uint64_t n_segments = 0;
  std::uint64_t n_samples = 0;                 // stream position: grid cells consumed, seen or missing
  std::uint64_t n_missing = 0;                 // channel samples masked out
  double window_power = 0.0;                   // sum of squared window values of one full segment
  std::vector<std::complex<double>> data_sum;  // mm^2
  std::vector<std::complex<double>> mask_sum;  // dimensionless

  [[nodiscard]] int n_bins() const noexcept { return n_fft / 2 + 1; }
  [[nodiscard]] int n_pairs() const noexcept { return n_channels * (n_channels + 1) / 2; }
  [[nodiscard]] static int pair_index(int i, int j, int n) noexcept { return i * n - i * (i - 1) / 2 + (j - i); }
};

}  // namespace core
