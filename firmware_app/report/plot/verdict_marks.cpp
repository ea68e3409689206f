#include "firmware_app/report/plot/verdict_marks.h"

#include <algorithm>

namespace app {
namespace {

using core::Verdict;

constexpr std::array<VerdictMark, 7> kMarks{
    VerdictMark{Verdict::kStructural, "mode", "modes", "v", Marker::kDot, "m0",
                "A mode of vibration of the structure."},
    VerdictMark{Verdict::kCameraMotion, "camera motion", "camera motion", "w", Marker::kTriangle, "k7 n",
                "All channels move alike: the camera moved, not the structure."},
    VerdictMark{Verdict::kInputPeak, "input peak", "input peaks", "w i", Marker::kSquare, "k1 n",
                "The base moves too: a peak of the input that shakes the structure, not of its response."},
    VerdictMark{Verdict::kHarmonic, "harmonic", "harmonics", "w o", Marker::kDiamond, "k4 n",
                "A machine running at constant speed, not a mode."},
    VerdictMark{Verdict::kAmbiguous, "alias open", "alias open", "w u", Marker::kRing, "k3 n",
                "A mode, but the frame rate leaves open which of its possible frequencies is the true one."},
    VerdictMark{Verdict::kCandidate, "candidate", "candidates", "w u", Marker::kRing, "k2 n",
                "May be a mode, but the record is too short for a verdict: seen over too few cycles."},
    VerdictMark{Verdict::kNumerical, "numerical", "numerical", "w", Marker::kCross, "k7 n",
                "Does not persist over the model orders, or its components are out of phase: not trusted."}};

}  // namespace

const std::array<VerdictMark, 7>& verdict_marks() noexcept { return kMarks; }

const VerdictMark& mark_of(core::Verdict verdict) noexcept {
  const auto found =
      std::find_if(kMarks.begin(), kMarks.end(), [&](const VerdictMark& mark) { return mark.verdict == verdict; });
  return found == kMarks.end() ? kMarks.back() : *found;
}

}  // namespace app
