#pragma once

#include <cstdint>

namespace core {

// From which frames a video codec predicts the others. It states a frame as a prediction and a rounded difference, so
// that a share of the motion between frames is left out or counted twice. The values are those of run_recording_t.
enum class FramePrediction : std::uint8_t {
  kUnknown,  // no video, or one that is not scanned
  kNone,     // every frame stands alone
  kPast,     // from earlier frames: the share shows as a delay or a lead
  kBoth      // from earlier and later frames: largely symmetric in time
};

}  // namespace core
