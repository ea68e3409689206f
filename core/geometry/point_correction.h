#pragma once

#include <array>

#include "core/geometry/camera_model.h"
#include "core/types/vector2.h"

namespace core {

// Correction of points estimated by core/closure, in addition to the declared camera. Undistorted pixels, in the order
// in which core/closure corrects the effects: tracking error, then lens.
struct PointCorrection {
  // Pixel locking along either axis, px: e(p) = sin (2 pi p), cos (2 pi p), sin (4 pi p), cos (4 pi p); a point at p is
  // measured at p + e.
  std::array<double, 4> locking_px{};
  CameraModel lens;         // in addition to the declared one; not calibrated: none
  bool in_keyframe = true;  // false: the effect began after the keyframe, whose points do not contain it

  [[nodiscard]] bool corrects() const noexcept;
  // NaN if no ray reaches the pixel.
  [[nodiscard]] Vector2 corrected(const Vector2& ideal_px) const noexcept;
  [[nodiscard]] Vector2 corrected_keyframe(const Vector2& ideal_px) const noexcept {
    return in_keyframe && corrects() ? corrected(ideal_px) : ideal_px;
  }
};

}  // namespace core
