#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/identification/folding.h"

namespace core::planning {

// Drift and sway of a hovering camera lie below this: 98 % of the variance in a measured flight.
inline constexpr double kHoverBandHz = 0.5;

enum class FoldOutlook {
  kDirect,     // no other frequency up to the highest searched appears at the same place
  kResolved,   // the row delays determine which of several it is
  kAmbiguous,  // the margin is below what the identification requires
  kNoDelays    // fewer than three regions, or all of them read at the same time
};

// Where a mode appears in samples of rate f_s, in the conventions of core/identification/folding.h: the true signed
// frequency is apparent + n f_s.
struct FoldPlace {
  double apparent_hz = 0.0;  // 0 .. f_s / 2; of the damped frequency f sqrt(1 - zeta^2)
  int n = 0;
  FoldOutlook outlook = FoldOutlook::kDirect;
  std::optional<double> margin;   // MPC of the true hypothesis (1: no noise here) minus the best of the others
  std::vector<double> rivals_hz;  // the alternatives, ascending
};

// The pole and the shape as observed by the camera, through the identification's own `unfold`. `shape` and
// folding.delay_s: per region.
[[nodiscard]] FoldPlace fold_place(double frequency_hz, double damping_ratio, const std::vector<double>& shape,
                                   const FoldingConfig& folding);

// Two apparent frequencies closer than the mean of the half-power widths 2 zeta f (aliasing keeps the width). Only the
// shapes distinguish them then; below half the width that fails too.
struct Overlap {
  std::size_t first = 0, second = 0;  // indices of the modes, first < second
  double gap_hz = 0.0, width_hz = 0.0;
  bool merges = false;
};
[[nodiscard]] std::vector<Overlap> overlaps(const std::vector<double>& apparent_hz,
                                            const std::vector<double>& half_power_hz);

// Closer to 0 or to half the rate than half its width: the mode overlaps with its own mirror image.
[[nodiscard]] bool at_edge(double apparent_hz, double half_power_hz, double rate_hz) noexcept;

}  // namespace core::planning
