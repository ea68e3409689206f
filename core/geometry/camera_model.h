#pragma once

#include <array>

#include "core/types/vector2.h"

namespace core {

// Pinhole camera with radial-tangential distortion (Brown 1971, OpenCV's k1 k2 p1 p2 k3). fx = 0: no calibration,
// points pass through unchanged.
struct CameraModel {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // px
  std::array<double, 5> distortion{};             // k1 k2 p1 p2 k3

  [[nodiscard]] bool calibrated() const noexcept { return fx > 0.0 && fy > 0.0; }
  // Raw pixel -> the pixel an undistorted camera with the same fx fy cx cy would see. Never an image, only points.
  [[nodiscard]] Vector2 undistort(const Vector2& raw_px) const noexcept;
  [[nodiscard]] Vector2 distort(const Vector2& ideal_px) const noexcept;
};

}  // namespace core
