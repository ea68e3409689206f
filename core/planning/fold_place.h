#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/identification/folding.h"

namespace core::planning {

// Drift and sway of a hovering camera lie below this: 98 % of the variance in a measured flight.
inline constexpr double kHoverBandHz = 0.5;

enum class FoldOutlook {
  kDirect,     // no other frequency up to the highest looked for is seen at the same place
  kResolved,   // the row delays tell which of several it is
  kAmbiguous,  // they tell too little: the margin is below what the identification asks for
  kNoDelays    // fewer than three regions, or all of them read at the same time
};

// Where a mode appears in samples of rate f_s, in the conventions of core/identification/folding.h: the true signed
// frequency is apparent + n f_s.
struct FoldPlace {
  double apparent_hz = 0.0;  // 0 .. f_s / 2; of the damped frequency f sqrt(1 - zeta^2)
  int n = 0;
  FoldOutlook outlook = FoldOutlook::kDirect;
  std::optional<double> margin;   // MPC of the true hypothesis (1: there is no noise here) minus the best of the others
  std::vector<double> rivals_hz;  // what else it could be, ascending
};

// The pole and the shape that the camera would see, through the identification's own `unfold`. `shape` and
// folding.delay_s: per region.
[[nodiscard]] FoldPlace fold_place(double frequency_hz, double damping_ratio, const std::vector<double>& shape,
                                   const FoldingConfig& folding);

// Two modes seen closer together than the mean of their half-power widths 2 zeta f (a fold keeps the width). Only
// their shapes tell them apart then; below half the width that breaks down too.
struct Overlap {
  std::size_t first = 0, second = 0;  // indices of the modes, first < second
  double gap_hz = 0.0, width_hz = 0.0;
  bool merges = false;
};
[[nodiscard]] std::vector<Overlap> overlaps(const std::vector<double>& apparent_hz,
                                            const std::vector<double>& half_power_hz);

// Closer to 0 or to half the rate than half its width: the mode and its own mirror image run into one another.
[[nodiscard]] bool at_edge(double apparent_hz, double half_power_hz, double rate_hz) noexcept;

}  // namespace core::planning
