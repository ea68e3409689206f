#include "core/geometry/camera_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace core {

namespace {

constexpr int kNewtonSteps = 40;
constexpr int kHalvings = 12;
constexpr double kTolerance = 1e-13;
constexpr double kGoodEnough = 1e-10;    // with strong lenses rounding prevents a smaller tolerance
constexpr double kWidestAngle = 1.5707;  // rad: at larger angles a ray has no pinhole image

struct Point {
  double x = 0.0, y = 0.0;
};

LensBend radial_tangential(const std::array<double, 8>& k, double x, double y) noexcept {
  const double r2 = x * x + y * y;
  const double above = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double below = 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double d_above = k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[4]);  // derivative by r2
  const double d_below = k[5] + r2 * (2.0 * k[6] + r2 * 3.0 * k[7]);
  const double radial = above / below;
  const double d_radial = (d_above - radial * d_below) / below;
  const double p1 = k[2];
  const double p2 = k[3];
  LensBend out;
  out.x = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
  out.y = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
  out.dx_dx = radial + 2.0 * x * x * d_radial + 2.0 * p1 * y + 6.0 * p2 * x;
  out.dx_dy = 2.0 * x * y * d_radial + 2.0 * p1 * x + 2.0 * p2 * y;
  out.dy_dx = out.dx_dy;
  out.dy_dy = radial + 2.0 * y * y * d_radial + 6.0 * p1 * y + 2.0 * p2 * x;
  return out;
}

// theta (1 + k1 theta^2 + ...), and its derivative.
Point angle_bent(const std::array<double, 8>& k, double theta) noexcept {
  const double t2 = theta * theta;
  return {theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))),
          1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])))};
}

LensBend equidistant(const std::array<double, 8>& k, double x, double y) noexcept {
  const double r = std::hypot(x, y);
  if (r < 1e-9) return {x, y};
  const auto [bent, slope] = angle_bent(k, std::atan(r));
  const double ratio = bent / r;
  const double along = slope / (1.0 + r * r);  // d r' / d r along the radius; across it the ratio r' / r
  const double cx = x / r;
  const double cy = y / r;
  return {x * ratio,
          y * ratio,
          along * cx * cx + ratio * cy * cy,
          (along - ratio) * cx * cy,
          (along - ratio) * cx * cy,
          along * cy * cy + ratio * cx * cx};
}

// Inverse of angle_bent on the interval from 0 on which it increases: Newton's method, bisection if a step leaves the
// bracket. NaN if there is no inverse.
double angle_unbent(const std::array<double, 8>& k, double bent) noexcept {
  constexpr int kPieces = 64;
  double low = 0.0;
  double high = 0.0;
  for (int i = 1; i <= kPieces; ++i) {
    high = kWidestAngle * i / kPieces;
    const auto [value, slope] = angle_bent(k, high);
    if (value >= bent) break;
    if (slope <= 0.0 || i == kPieces) return std::numeric_limits<double>::quiet_NaN();
    low = high;
  }
  double theta = std::clamp(bent, low, high);
  for (int i = 0; i < 2 * kNewtonSteps; ++i) {
    const auto [value, slope] = angle_bent(k, theta);
    const double error = value - bent;
    if (std::abs(error) < kTolerance) break;
    (error < 0.0 ? low : high) = theta;
    theta -= error / slope;
    if (!(theta > low && theta < high)) theta = 0.5 * (low + high);
  }
  return theta;
}

// Newton's method from `p`, where the determinant is positive, towards the point that is seen at `raw`.
bool newton(const CameraModel& camera, Point raw, Point& p) noexcept {
  LensBend at = bend(camera, p.x, p.y);
  double error = std::hypot(raw.x - at.x, raw.y - at.y);
  for (int i = 0; i < kNewtonSteps && error > kTolerance; ++i) {
    const double determinant = at.determinant();
    const double ex = raw.x - at.x;
    const double ey = raw.y - at.y;
    const double step_x = (at.dy_dy * ex - at.dx_dy * ey) / determinant;
    const double step_y = (at.dx_dx * ey - at.dy_dx * ex) / determinant;
    bool better = false;
    double share = 1.0;
    for (int j = 0; j < kHalvings && !better; ++j, share *= 0.5) {
      const Point next{p.x + share * step_x, p.y + share * step_y};
      const LensBend there = bend(camera, next.x, next.y);
      const double there_error = std::hypot(raw.x - there.x, raw.y - there.y);
      if (!(there_error < error) || !(there.determinant() > 0.0)) continue;  // a NaN counts as no progress
      better = true;
      p = next, at = there, error = there_error;
    }
    if (!better) break;
  }
  return error < kGoodEnough;
}

// True if the lens does not fold between the axis and `p`: otherwise another ray is seen at the same
// pixel.
bool on_branch_of_axis(const CameraModel& camera, Point p) noexcept {
  constexpr int kSteps = 8;
  for (int i = 1; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    if (!(bend(camera, share * p.x, share * p.y).determinant() > 0.0)) return false;
  }
  return true;
}

// Newton's method from the axis outwards, in steps short enough to stay on its branch.
bool continued(const CameraModel& camera, Point raw, Point& p) noexcept {
  constexpr int kSteps = 32;
  p = {};
  for (int i = 1; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    if (!newton(camera, {share * raw.x, share * raw.y}, p)) return false;
  }
  return on_branch_of_axis(camera, p);
}

}  // namespace

LensBend bend(const CameraModel& camera, double x, double y) noexcept {
  return camera.lens == LensModel::kEquidistant ? equidistant(camera.distortion, x, y)
                                                : radial_tangential(camera.distortion, x, y);
}

bool CameraModel::distorts() const noexcept {
  return calibrated() && (lens == LensModel::kEquidistant ||
                          std::any_of(distortion.begin(), distortion.end(), [](double k) { return k != 0.0; }));
}

Vector2 CameraModel::distort(const Vector2& ideal_px) const noexcept {
  if (!calibrated()) return ideal_px;
  const LensBend d = bend(*this, (ideal_px.u - cx) / fx, (ideal_px.v - cy) / fy);
  return {cx + fx * d.x, cy + fy * d.y};
}

Vector2 CameraModel::undistort(const Vector2& raw_px) const noexcept {
  if (!calibrated()) return raw_px;
  const Point raw{(raw_px.u - cx) / fx, (raw_px.v - cy) / fy};
  Point p = raw;
  if (lens == LensModel::kEquidistant) {
    const double r = std::hypot(raw.x, raw.y);
    const double stretch = r > 1e-12 ? std::tan(angle_unbent(distortion, r)) / r : 1.0;
    p = {raw.x * stretch, raw.y * stretch};
  } else if (distorts()) {
    const bool found =
        bend(*this, p.x, p.y).determinant() > 0.0 && newton(*this, raw, p) && on_branch_of_axis(*this, p);
    if (!found && !continued(*this, raw, p)) {
      const double none = std::numeric_limits<double>::quiet_NaN();
      return {none, none};
    }
  }
  return {cx + fx * p.x, cy + fy * p.y};
}

}  // namespace core
