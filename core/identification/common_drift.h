#pragma once

#include <cstddef>
#include <optional>

#include "core/types/modal_estimate.h"

namespace core {

// Frequency drift common to the modes of one structure (temperature, moisture, a growing load), relative to the
// frequency.
struct CommonDrift {
  double share_per_s = 0.0;  // 1e-5 = 0.06 % per minute
  double std_per_s = 0.0;
  bool drifts = false;  // the drift exceeds four standard deviations
  std::size_t n_modes = 0;
};

// Mean of the modes' own relative trends (ModeHistory), weighted by their inverse variances; its standard deviation is
// raised by sqrt(chi^2 / (n - 1)) if the modes disagree. It is about sqrt(n) times more sensitive than the trend of one
// mode. Empty: fewer than two structural modes with a trend.
[[nodiscard]] std::optional<CommonDrift> common_drift(const ModalEstimate& estimate) noexcept;

}  // namespace core
