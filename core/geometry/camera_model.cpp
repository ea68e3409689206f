#include "core/geometry/camera_model.h"

namespace core {

namespace {
// Fixed-point steps; each gains about a digit for the distortion of real lenses (|k1| < 0.4).
constexpr int kIterations = 20;

Vector2 distort_normalised(const std::array<double, 5>& k, double x, double y) noexcept {
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y};
}
}  // namespace

Vector2 CameraModel::distort(const Vector2& ideal_px) const noexcept {
  if (!calibrated()) return ideal_px;
  const Vector2 d = distort_normalised(distortion, (ideal_px.u - cx) / fx, (ideal_px.v - cy) / fy);
  return {cx + fx * d.u, cy + fy * d.v};
}

Vector2 CameraModel::undistort(const Vector2& raw_px) const noexcept {
  if (!calibrated()) return raw_px;
  const double x_raw = (raw_px.u - cx) / fx;
  const double y_raw = (raw_px.v - cy) / fy;
  double x = x_raw;
  double y = y_raw;
  for (int i = 0; i < kIterations; ++i) {
    const Vector2 d = distort_normalised(distortion, x, y);
    x += x_raw - d.u;
    y += y_raw - d.v;
  }
  return {cx + fx * x, cy + fy * y};
}

}  // namespace core
