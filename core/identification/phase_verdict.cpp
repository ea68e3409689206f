#include "core/identification/phase_verdict.h"

#include "core/identification/phase_line.h"
#include "core/identification/verdict_words.h"

namespace core {

namespace {

constexpr double kChance = 3.5;            // times the expected share beside the line; 2.5 loses 9 of 1800 true modes
constexpr double kLeastCertainMpc = 0.85;  // of a mode whose alias order was chosen ...
constexpr double kClearFoldMargin = 0.65;  // ... unless every other one is this much worse
constexpr double kLeastKnownWidth = 0.35;  // sigma of the frequency, of zeta f (half the half-power width)

bool is_open(const Mode& mode) {
  return mode.verdict == Verdict::kStructural || mode.verdict == Verdict::kAmbiguous ||
         mode.verdict == Verdict::kCandidate;
}

bool is_within_chance(const Mode& mode, const std::optional<ModeScatter>& scatter) {
  if (!scatter || !mode.frequency_std_hz) return false;
  return share_beside_line(mode.mpc) <= kChance * scatter->beside_line &&
         *mode.frequency_std_hz < kLeastKnownWidth * mode.damping_ratio * mode.frequency_hz;
}

}  // namespace

void reject_out_of_phase(double min_mpc, const Sigmas& sigmas, std::vector<Mode>& modes) {
  for (std::size_t i = 0; i < modes.size(); ++i) {
    Mode& mode = modes[i];
    const bool is_uncertain_fold = mode.fold_n && mode.mpc < kLeastCertainMpc && *mode.fold_margin < kClearFoldMargin;
    if (!is_open(mode) || (mode.mpc >= min_mpc && !is_uncertain_fold)) continue;
    if (is_within_chance(mode, sigmas.scatter[i])) {
      mode.reason += "; its phases differ no more than they scatter";
    } else if (mode.mpc < min_mpc) {
      set_numerical(mode, in_words("components not in phase: MPC %.2f < %.2f", mode.mpc, min_mpc));
    } else if (mode.verdict == Verdict::kStructural) {
      set(mode, Verdict::kAmbiguous,
          in_words("a mode, but its alias order is open: fold margin %.2f, MPC %.2f", *mode.fold_margin, mode.mpc));
    }
  }
}

std::vector<bool> state_along_line(const Sigmas& sigmas, std::vector<Mode>& modes) {
  std::vector<bool> along(modes.size(), false);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (!is_open(modes[i]) || !is_within_chance(modes[i], sigmas.scatter[i])) continue;
    along[i] = true;
    modes[i].shape = along_phase_line(modes[i].shape);
    modes[i].shape_std = sigmas.scatter[i]->along;
  }
  return along;
}

}  // namespace core
