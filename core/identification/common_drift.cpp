#include "core/identification/common_drift.h"

#include <algorithm>
#include <cmath>

namespace core {

std::optional<CommonDrift> common_drift(const ModalEstimate& estimate) noexcept {
  constexpr double kSigmas = 4.0;
  CommonDrift out;
  double weights = 0.0, sum = 0.0, sum_of_squares = 0.0;
  for (const Mode& mode : estimate.modes) {
    if (!mode.history || !mode.history->drift_hz_per_s || !mode.history->drift_std_hz_per_s) continue;
    const double share = *mode.history->drift_hz_per_s / mode.frequency_hz;
    const double weight = std::pow(mode.frequency_hz / *mode.history->drift_std_hz_per_s, 2);
    if (!std::isfinite(share) || !std::isfinite(weight)) continue;
    weights += weight;
    sum += weight * share;
    sum_of_squares += weight * share * share;
    ++out.n_modes;
  }
  if (out.n_modes < 2 || !(weights > 0.0)) return std::nullopt;
  out.share_per_s = sum / weights;
  const double chi_squared = sum_of_squares - sum * out.share_per_s;
  const double disagreement = chi_squared / static_cast<double>(out.n_modes - 1);
  out.std_per_s = std::sqrt(std::max(1.0, disagreement) / weights);
  out.drifts = std::abs(out.share_per_s) > kSigmas * out.std_per_s;
  return out;
}

}  // namespace core
