#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/types/cpsd.h"

namespace core {

enum class CorrelationStatus : std::uint8_t { kOk, kNoSegment, kNotFinite, kNoPower, kTooFewSamples };

// A constant channel has the rounding error of its mean (1e-13 of a metre); no camera resolves a nanometre.
inline constexpr double kLeastPowerMm2 = 1e-18;

// Correlation functions R_ij(lag) = E[x_i(t + lag) x_j(t)], lag -max_lag .. max_lag, of the d-times differenced
// channels (NExT: James, Carne & Lauffer 1993). `divided`: unbiased, divided by the mask's own correlation
// (core/spectrum/METHOD.md); used for the realisation. `undivided`: the positive semidefinite estimate; used for its
// weights. Without differences both are equal at lag 0.
class Correlations {
 public:
  Correlations() = default;
  Correlations(int n_channels, int max_lag);

  [[nodiscard]] int n_channels() const noexcept { return n_channels_; }
  [[nodiscard]] int max_lag() const noexcept { return max_lag_; }
  [[nodiscard]] double divided(int i, int j, int lag) const noexcept { return divided_[index(i, j, lag)]; }
  [[nodiscard]] double undivided(int i, int j, int lag) const noexcept { return undivided_[index(i, j, lag)]; }
  void set(int i, int j, int lag, double divided, double undivided) noexcept {  // i <= j
    divided_[index(i, j, lag)] = divided;
    undivided_[index(i, j, lag)] = undivided;
  }

 private:
  [[nodiscard]] std::size_t index(int i, int j, int lag) const noexcept {
    const bool mirrored = i > j;  // R_ij(lag) = R_ji(-lag)
    const auto pair = static_cast<std::size_t>(CpsdSums::pair_index(mirrored ? j : i, mirrored ? i : j, n_channels_));
    return pair * static_cast<std::size_t>(2 * max_lag_ + 1) +
           static_cast<std::size_t>((mirrored ? -lag : lag) + max_lag_);
  }

  int n_channels_ = 0;
  int max_lag_ = 0;
  std::vector<double> divided_;  // pairs (i <= j) x (2 max_lag + 1)
  std::vector<double> undivided_;
};

// Prewhitening by `n_differences` differences is applied to the lags, R_d(lag) = 2 R(lag) - R(lag - 1) - R(lag + 1),
// after the division: differences of a windowed signal are not those of the signal, and the window's slope would shift
// the lowest mode. Without it, the hover drift, 40 dB above the modes, would determine the ridge and the rounding
// errors; shapes and poles are unchanged. With named `references`, only the pairs that contain one and each channel's
// own are computed; the others are zero. least_power: a channel with less power counts as static, in its unit squared.
[[nodiscard]] CorrelationStatus compute_correlations(const CpsdSums& sums, int max_lag, int n_differences,
                                                     Correlations& out, std::span<const int> references = {},
                                                     double least_power = kLeastPowerMm2);

[[nodiscard]] const char* to_string(CorrelationStatus status) noexcept;

}  // namespace core
