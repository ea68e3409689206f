#include "core/geometry/lens_fault.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace core {
namespace {

constexpr int kDirections = 180;
constexpr double kFarthest = 57.0;  // tan of 89 degrees

struct Rectangle {
  double left, top, right, bottom;
  [[nodiscard]] bool holds(double u, double v) const noexcept {
    return u >= left && u <= right && v >= top && v <= bottom;
  }
};

std::optional<LensFault> fault_along(const CameraModel& camera, const Rectangle& image, double cos_phi,
                                     double sin_phi) noexcept {
  const double pixel = 1.0 / std::max(camera.fx, camera.fy);
  double r_next = 0.0;
  for (double r = 0.0; r < kFarthest; r = r_next) {
    const LensBend at = bend(camera, r * cos_phi, r * sin_phi);
    const double u = camera.cx + camera.fx * at.x;
    const double v = camera.cy + camera.fy * at.y;
    // A pole of the rational model gives values that are not finite; it appears as a fold or a jump.
    if (!(at.determinant() > 0.0) || !std::isfinite(u) || !std::isfinite(v)) {
      return LensFault{{u, v}, std::hypot(u - camera.cx, v - camera.cy), std::atan(r) * 180.0 / std::numbers::pi};
    }
    if (!image.holds(u, v)) return std::nullopt;
    r_next = r + std::max(std::min(pixel, 0.01), 0.002 * r);
  }
  return std::nullopt;
}

}  // namespace

std::optional<LensFault> lens_fault(const CameraModel& camera, int width_px, int height_px) noexcept {
  if (!camera.distorts()) return std::nullopt;
  const Rectangle image{std::min(0.0, camera.cx), std::min(0.0, camera.cy), std::max(width_px - 1.0, camera.cx),
                        std::max(height_px - 1.0, camera.cy)};
  std::optional<LensFault> nearest;
  for (int i = 0; i < kDirections; ++i) {
    const double phi = 2.0 * std::numbers::pi * i / kDirections;
    const auto fault = fault_along(camera, image, std::cos(phi), std::sin(phi));
    if (fault && (!nearest || fault->radius_px < nearest->radius_px)) nearest = fault;
  }
  return nearest;
}

}  // namespace core
