#pragma once

#include <array>

#include "core/geometry/camera_model.h"
#include "core/types/vector2.h"

namespace core {

// What a record itself has told of tracker and lens beyond what was declared (core/closure). Undistorted pixels, in the
// order in which core/closure takes the effects out: the tracker's error, then the lens.
struct PlaceCorrection {
  // e(p) = sin (2 pi p), cos (2 pi p), sin (4 pi p), cos (4 pi p) along either axis, px: a place p is measured at p +
  // e.
  std::array<double, 4> locking_px{};
  CameraModel lens;         // beyond the declared one; not calibrated: none
  bool in_keyframe = true;  // false: it began after the keyframe, whose points have none of it

  [[nodiscard]] bool corrects() const noexcept;
  // NaN where the lens shows no ray.
  [[nodiscard]] Vector2 corrected(const Vector2& ideal_px) const noexcept;
  [[nodiscard]] Vector2 corrected_keyframe(const Vector2& ideal_px) const noexcept {
    return in_keyframe && corrects() ? corrected(ideal_px) : ideal_px;
  }
};

}  // namespace core
