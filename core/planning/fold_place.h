#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/identification/folding.h"

namespace core::planning {

// Upper band limit of a hovering camera's drift and sway: 98 % of the variance in a measured flight.
inline constexpr double kHoverBandHz = 0.5;

enum class FoldOutlook {
  kDirect,     // no other frequency in the search range appears at the same apparent frequency
  kResolved,   // the row delays determine the true frequency
  kAmbiguous,  // the margin is below what the identification requires
  kNoDelays    // fewer than three regions, or all of them read at the same time
};

// Apparent frequency of a mode in samples of rate f_s, in the conventions of core/identification/folding.h: the true
// signed frequency is apparent + n f_s.
struct FoldPlace {
  double apparent_hz = 0.0;  // 0 .. f_s / 2; of the damped frequency f sqrt(1 - zeta^2)
  int n = 0;
  FoldOutlook outlook = FoldOutlook::kDirect;
  std::optional<double> margin;   // MPC of the true hypothesis (1: without noise) minus the best of the others
  std::vector<double> rivals_hz;  // the alternatives, ascending
};

// Pole and shape as observed by the camera, computed with the identification's own `unfold`. `shape` and
// folding.delay_s: per region.
[[nodiscard]] FoldPlace fold_place(double frequency_hz, double damping_ratio, const std::vector<double>& shape,
                                   const FoldingConfig& folding);

// Two apparent frequencies closer than the mean of their half-power widths 2 zeta f (aliasing preserves the width).
// Then only the shapes distinguish them; below half the width not even these do.
struct Overlap {
  std::size_t first = 0, second = 0;  // indices of the modes, first < second
  double gap_hz = 0.0, width_hz = 0.0;
  bool merges = false;
};
[[nodiscard]] std::vector<Overlap> overlaps(const std::vector<double>& apparent_hz,
                                            const std::vector<double>& half_power_hz);

// True if the mode is closer to 0 or to half the rate than half its width: it overlaps with its own mirror image.
[[nodiscard]] bool at_edge(double apparent_hz, double half_power_hz, double rate_hz) noexcept;

}  // namespace core::planning
