#pragma once

#include <algorithm>
#include <complex>
#include <span>
#include <vector>

#include "core/spectrum/real_fft.h"
#include "core/types/cpsd.h"

namespace core {

// Transforms sums of cross-spectra to circular lags, pair by pair. Borrows the sums.
class PairTransform {
 public:
  explicit PairTransform(const CpsdSums& sums)
      : sums_(sums), fft_(sums.n_fft), bins_(static_cast<std::size_t>(sums.n_bins())) {
    spectrum_.resize(bins_);
  }

  // Inverse transform of one pair's sum. out: n_fft circular lags.
  void inverse(const std::vector<std::complex<double>>& sum, int pair, std::vector<double>& out) {
    const auto pairs = static_cast<std::size_t>(sums_.n_pairs());
    for (std::size_t k = 0; k < bins_; ++k) spectrum_[k] = sum[k * pairs + static_cast<std::size_t>(pair)];
    finish(out);
  }

  // The same for the joined sums of the blocks.
  void inverse(std::span<const CpsdBlock> blocks, std::vector<std::complex<double>> CpsdBlock::*sum, int pair,
               std::vector<double>& out) {
    const auto pairs = static_cast<std::size_t>(sums_.n_pairs());
    std::fill(spectrum_.begin(), spectrum_.end(), std::complex<double>());
    for (const CpsdBlock& block : blocks) {
      for (std::size_t k = 0; k < bins_; ++k) spectrum_[k] += (block.*sum)[k * pairs + static_cast<std::size_t>(pair)];
    }
    finish(out);
  }

 private:
  void finish(std::vector<double>& out) {
    out.resize(static_cast<std::size_t>(sums_.n_fft));
    fft_.inverse(spectrum_, out);
  }

  const CpsdSums& sums_;
  RealFft fft_;
  std::size_t bins_;
  std::vector<std::complex<double>> spectrum_;
};

// R_d(lag) = 2 R(lag) - R(lag - 1) - R(lag + 1), n times; each time a value is lost at either end.
inline void difference_lags(std::vector<double>& values, int n_differences) {
  for (int d = 0; d < n_differences; ++d) {
    for (std::size_t k = 0; k + 2 < values.size(); ++k) values[k] = 2.0 * values[k + 1] - values[k] - values[k + 2];
    values.resize(values.size() - 2);
  }
}

// True if all channels lack the same samples, or none. Then one mask serves all pairs.
inline bool one_mask(const CpsdSums& sums) {
  const auto pairs = static_cast<std::size_t>(sums.n_pairs());
  for (std::size_t k = 0; k < sums.mask_sum.size(); k += pairs) {
    for (std::size_t pair = 1; pair < pairs; ++pair) {
      if (sums.mask_sum[k + pair] != sums.mask_sum[k]) return false;
    }
  }
  return true;
}

// Index of a lag in the inverse transform.
inline std::size_t circular(int lag, int n_fft) { return static_cast<std::size_t>(lag >= 0 ? lag : n_fft + lag); }

}  // namespace core
