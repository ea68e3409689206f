#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/types/vector2.h"

namespace core {

enum class LensModel : std::uint8_t { kRadialTangential, kEquidistant };

// Pinhole camera and its lens, x = (u - cx)/fx, y = (v - cy)/fy of an ideal pixel, r^2 = x^2 + y^2.
//   kRadialTangential (Brown 1971; rational form: Claus & Fitzgibbon 2005; order and signs as OpenCV): k1 k2 p1 p2 k3
//   k4 k5 k6
//     x' = x R + 2 p1 x y + p2 (r^2 + 2 x^2), y' likewise, R = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 +
//     k6 r^6)
//   kEquidistant (Kannala & Brandt 2006; OpenCV's fisheye, Kalibr's equidistant): k1 k2 k3 k4
//     theta = atan r, r' = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
// Kalibr's `radtan` is the first with four coefficients. fx = 0: no calibration, points pass through unchanged.
struct CameraModel {
  double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  // px
  std::array<double, 8> distortion{};
  LensModel lens = LensModel::kRadialTangential;

  [[nodiscard]] bool calibrated() const noexcept { return fx > 0.0 && fy > 0.0; }
  [[nodiscard]] bool distorts() const noexcept;
  // Raw pixel -> the pixel that an undistorted camera with the same fx fy cx cy would see. For points, not for images.
  // NaN if no ray reaches the pixel: beyond the circle at which the distortion folds back, or 90 degrees and more off
  // the axis. Newton's method on the branch that starts at the axis, to 1e-12 of the focal length.
  [[nodiscard]] Vector2 undistort(const Vector2& raw_px) const noexcept;
  [[nodiscard]] Vector2 distort(const Vector2& ideal_px) const noexcept;
};

// Distortion in normalised coordinates (focal length 1) with its derivatives; used by the two functions above.
struct LensBend {
  double x = 0.0, y = 0.0;
  double dx_dx = 1.0, dx_dy = 0.0, dy_dx = 0.0, dy_dy = 1.0;
  [[nodiscard]] double determinant() const noexcept { return dx_dx * dy_dy - dx_dy * dy_dx; }
};
[[nodiscard]] LensBend bend(const CameraModel& camera, double x, double y) noexcept;

}  // namespace core
