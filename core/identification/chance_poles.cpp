#include "core/identification/chance_poles.h"

#include <cmath>

#include "core/identification/mode_sigmas.h"
#include "core/identification/verdict_words.h"

namespace core {

namespace {
constexpr double kMostOfLeastSigma = 2.75;
}

void reject_chance_poles(double duration_s, std::vector<Mode>& modes) {
  for (Mode& mode : modes) {
    if (mode.verdict != Verdict::kStructural && mode.verdict != Verdict::kAmbiguous) continue;
    if (!(mode.presence < 1.0) || !mode.frequency_std_hz) continue;
    const double least_hz = std::sqrt(least_variances(mode, duration_s).frequency_hz);
    if (!(least_hz > 0.0) || *mode.frequency_std_hz <= kMostOfLeastSigma * least_hz) continue;
    set(mode, Verdict::kNumerical,
        in_words("found in %.0f %% of the orders, with a frequency known to %.2g Hz: a mode with this damping is known "
                 "%.1f times better",
                 100.0 * mode.presence, *mode.frequency_std_hz, *mode.frequency_std_hz / least_hz));
    mode.frequency_std_hz.reset(), mode.damping_std.reset(), mode.shape_std.clear();
  }
}

}  // namespace core
