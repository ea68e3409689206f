#pragma once

#include <cstddef>
#include <optional>

#include "core/types/modal_estimate.h"

namespace core {

// Drift that the modes of one structure share, as warming, drying or a growing load make it: relative to the frequency.
struct CommonDrift {
  double share_per_s = 0.0;  // 1e-5 = 0.06 % a minute
  double std_per_s = 0.0;
  bool drifts = false;  // beyond four standard deviations
  std::size_t n_modes = 0;
};

// Mean of the modes' own relative trends (ModeHistory), weighted by their inverse variances; its standard deviation is
// raised by sqrt(chi^2 / (n - 1)) where the modes disagree. Sees about sqrt(n) times less than one mode's trend does.
// Empty: fewer than two structural modes with a trend.
[[nodiscard]] std::optional<CommonDrift> common_drift(const ModalEstimate& estimate) noexcept;

}  // namespace core
