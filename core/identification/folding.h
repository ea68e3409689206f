#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

namespace core {

// Alias order. A pole seen at f_a in samples of rate f_s may have any signed frequency f_a + n f_s. If channels are
// seen at different instants (row delays), n can be determined: removing the delays at the true frequency makes the
// shape's phases collinear (core/identification/METHOD.md).
struct FoldingConfig {
  double rate_hz = 0.0;
  double max_frequency_hz = 0.0;  // hypotheses |f_a + n f_s| beyond it are not considered
  std::vector<double> delay_s;    // per channel
  // Per channel; empty = all displacements. A velocity component is s times, an acceleration s^2 times the
  // displacement.
  std::vector<int> n_integrations = {};
};

struct UnfoldedPole {
  std::complex<double> s;                   // continuous pole, rad/s, Im > 0
  double apparent_hz = 0.0;                 // 0 .. f_s / 2
  std::vector<std::complex<double>> shape;  // without delays, as displacement, largest component 1
  double mpc = 0.0, emac = 0.0;
  std::optional<int> fold_n;          // empty: cannot be determined (fewer than three channels, or no delays)
  std::optional<double> fold_margin;  // best MPC minus second-best MPC
  // Other frequencies below the limit are possible, and the delays cannot distinguish them: s and shape are those of n
  // = 0, mpc is that of the best hypothesis.
  bool fold_open = false;
};

// Alias orders n with |f_a + n f_s| up to `limit_hz`, ascending.
[[nodiscard]] std::vector<int> alias_orders(double apparent_hz, double rate_hz, double limit_hz);

// Undoes delay and integrations of one channel: of a component as observed, the displacement at the signed pole s.
[[nodiscard]] std::complex<double> as_displacement(std::complex<double> component, std::complex<double> s,
                                                   std::size_t channel, const FoldingConfig& config);

// lambda: discrete pole with Im > 0. shape: as observed.
[[nodiscard]] UnfoldedPole unfold(std::complex<double> lambda, const std::vector<std::complex<double>>& shape,
                                  const FoldingConfig& config);

// Other true frequencies that this pole may have, ascending, at most kMostOthers: |f_a + n f_s| up to max_frequency_hz
// (0: up to kOthersUpTo f_s), except those that the delays exclude by a margin of MPC. Empty if max_frequency_hz
// declares that no mode lies above half the rate.
inline constexpr std::size_t kMostOthers = 4;
inline constexpr double kOthersUpTo = 2.5;
[[nodiscard]] std::vector<double> other_frequencies(const UnfoldedPole& pole, const FoldingConfig& config,
                                                    double least_margin);

// The shape as observed, including the delays.
[[nodiscard]] std::vector<std::complex<double>> observed_shape(const UnfoldedPole& pole, const FoldingConfig& config);

// True if the delay span is long enough to distinguish n = 0 from n = +-1.
[[nodiscard]] bool folding_observable(const FoldingConfig& config) noexcept;

// Scales a shape so that its largest component is 1 (real).
void normalise_shape(std::vector<std::complex<double>>& shape) noexcept;

}  // namespace core
