#include "core/types/modal_estimate.h"

namespace core {

const char* to_string(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::kStructural:
      return "structural";
    case Verdict::kCameraMotion:
      return "camera_motion";
    case Verdict::kInputPeak:
      return "input_peak";
    case Verdict::kHarmonic:
      return "harmonic";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kNumerical:
      return "numerical";
    case Verdict::kCandidate:
      return "candidate";
  }
  return "numerical";
}

}  // namespace core
