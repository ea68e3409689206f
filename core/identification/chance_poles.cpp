#include "core/identification/chance_poles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "core/identification/listed_modes.h"
#include "core/identification/mode_sigmas.h"
#include "core/identification/verdict_words.h"

namespace core {

namespace {

constexpr double kMostOfLeastSigma = 2.75;
constexpr double kVague = 0.1;  // sigma of a frequency, of the frequency

bool is_mode(const Mode& mode) noexcept {
  return mode.verdict == Verdict::kStructural || mode.verdict == Verdict::kAmbiguous;
}

// Sigma of the frequency over the least one, where both are known.
std::optional<double> of_least_sigma(const Mode& mode, double duration_s) {
  const double least_hz = std::sqrt(least_variances(mode, duration_s).frequency_hz);
  if (!mode.frequency_std_hz || !(least_hz > 0.0)) return std::nullopt;
  return *mode.frequency_std_hz / least_hz;
}

bool is_vague(const Mode& mode) {
  return is_mode(mode) && mode.frequency_std_hz.value_or(0.0) > kVague * mode.frequency_hz;
}

}  // namespace

void reject_chance_poles(const std::vector<bool>& is_late, double duration_s, std::vector<Mode>& modes) {
  for (std::size_t i = 0; i < modes.size(); ++i) {
    Mode& mode = modes[i];
    if (!is_mode(mode) && !(mode.verdict == Verdict::kCandidate && is_late[i])) continue;
    if (!is_late[i] && !(mode.presence < 1.0)) continue;
    const std::optional<double> of_least = of_least_sigma(mode, duration_s);
    if (of_least && *of_least > kMostOfLeastSigma) {
      set_numerical(mode,
                    in_words("found in %.0f %% of the orders, with a frequency known to %.2g Hz: a mode with this "
                             "damping is known %.1f times better",
                             100.0 * mode.presence, *mode.frequency_std_hz, *of_least));
    } else if (!of_least && is_late[i]) {
      set_numerical(mode, in_words("found in %.0f %% of the orders, without a sigma", 100.0 * mode.presence));
    }
  }
}

void reject_vague_modes(std::vector<Mode>& modes) {
  for (Mode& mode : modes) {
    if (!is_vague(mode)) continue;
    set_numerical(mode, in_words("found in %.0f %% of the orders, but with a frequency known to %.2g Hz alone",
                                 100.0 * mode.presence, *mode.frequency_std_hz));
  }
}

void reject_vague_modes(ModalEstimate& estimate) {
  std::vector<Mode>& modes = estimate.modes;
  if (std::none_of(modes.begin(), modes.end(), is_vague)) return;
  reject_vague_modes(modes);
  std::vector<ListedMode> structural, rejected = listed_modes(estimate.rejected, static_cast<int>(modes.size()));
  for (ListedMode& one : listed_modes(modes, 0))
    (one.mode.verdict == Verdict::kNumerical ? rejected : structural).push_back(std::move(one));
  list_again(std::move(structural), std::move(rejected), estimate);
}

}  // namespace core
