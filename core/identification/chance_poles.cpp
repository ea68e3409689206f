#include "core/identification/chance_poles.h"

#include <cmath>
#include <cstddef>

#include "core/identification/mode_sigmas.h"
#include "core/identification/verdict_words.h"

namespace core {

namespace {
constexpr double kMostOfLeastSigma = 2.75;
}  // namespace

void reject_chance_poles(const std::vector<bool>& is_late, double duration_s, std::vector<Mode>& modes) {
  for (std::size_t i = 0; i < modes.size(); ++i) {
    Mode& mode = modes[i];
    const bool is_mode = mode.verdict == Verdict::kStructural || mode.verdict == Verdict::kAmbiguous;
    if (!is_mode && !(mode.verdict == Verdict::kCandidate && is_late[i])) continue;
    if (!is_late[i] && !(mode.presence < 1.0)) continue;
    const double least_hz = std::sqrt(least_variances(mode, duration_s).frequency_hz);
    if (!mode.frequency_std_hz || !(least_hz > 0.0)) {
      if (is_late[i])
        set_numerical(mode, in_words("found in %.0f %% of the orders, without a sigma", 100.0 * mode.presence));
    } else if (*mode.frequency_std_hz > kMostOfLeastSigma * least_hz) {
      set_numerical(
          mode, in_words("found in %.0f %% of the orders, with a frequency known to %.2g Hz: a mode with this damping "
                         "is known %.1f times better",
                         100.0 * mode.presence, *mode.frequency_std_hz, *mode.frequency_std_hz / least_hz));
    }
  }
}

}  // namespace core
