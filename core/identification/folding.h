#pragma once

#include <complex>
#include <optional>
#include <vector>

namespace core {

// Alias order. A pole seen at f_a in samples of rate f_s may be any signed frequency f_a + n f_s. Channels seen at
// different instants (row delays) determine n: undoing the delays with the true pole makes the shape's phases collinear
// (core/identification/METHOD.md).
struct FoldingConfig {
  double rate_hz = 0.0;
  double max_frequency_hz = 0.0;  // |f_a + n f_s| beyond it are not considered
  std::vector<double> delay_s;    // per channel
  // Per channel; empty = all displacements. A velocity row is s times, an acceleration row s^2 times the displacement.
  std::vector<int> n_integrations = {};
};

struct UnfoldedPole {
  std::complex<double> s;                   // continuous pole, rad/s, Im > 0
  double apparent_hz = 0.0;                 // 0 .. f_s / 2
  std::vector<std::complex<double>> shape;  // delays undone, in displacement, largest component 1
  double mpc = 0.0, emac = 0.0;
  std::optional<int> fold_n;          // empty: cannot be told (fewer than three channels, or no delays)
  std::optional<double> fold_margin;  // best MPC minus second best
  // There are other frequencies below the limit, and the delays cannot distinguish them: s and shape are those of n =
  // 0, mpc is that of the best.
  bool fold_open = false;
};

// lambda: discrete pole with Im > 0. shape: as observed.
[[nodiscard]] UnfoldedPole unfold(std::complex<double> lambda, const std::vector<std::complex<double>>& shape,
                                  const FoldingConfig& config);

// Every other true frequency that this pole may have, ascending, at most kMostOthers: of |f_a + n f_s| up to
// max_frequency_hz (0: up to kOthersUpTo f_s), those that the delays do not exclude by a margin of MPC. None where
// max_frequency_hz declares that nothing is above half the rate.
inline constexpr std::size_t kMostOthers = 4;
inline constexpr double kOthersUpTo = 2.5;
[[nodiscard]] std::vector<double> other_frequencies(const UnfoldedPole& pole, const FoldingConfig& config,
                                                    double least_margin);

// The shape as observed, with the delays.
[[nodiscard]] std::vector<std::complex<double>> observed_shape(const UnfoldedPole& pole, const FoldingConfig& config);

// Is the delay span long enough to distinguish n = 0 from n = +-1?
[[nodiscard]] bool folding_observable(const FoldingConfig& config) noexcept;

// Scales a shape so that its largest component is 1 (real).
void normalise_shape(std::vector<std::complex<double>>& shape) noexcept;

}  // namespace core
