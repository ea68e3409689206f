#include "core/geometry/point_correction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace core {
namespace {

// Newton's method on p + e(p) = measured. If e is so steep that two positions fit, the nearest is used.
double unlocked(double measured_px, const std::array<double, 4>& e) noexcept {
  constexpr int kSteps = 6;
  constexpr double kLeastSlope = 0.3, kTurn = 2.0 * std::numbers::pi;
  double p = measured_px;
  for (int step = 0; step < kSteps; ++step) {
    const double s = std::sin(kTurn * p), c = std::cos(kTurn * p);
    const double s2 = 2.0 * s * c, c2 = c * c - s * s;
    const double error = e[0] * s + e[1] * c + e[2] * s2 + e[3] * c2;
    const double slope = 1.0 + kTurn * (e[0] * c - e[1] * s + 2.0 * (e[2] * c2 - e[3] * s2));
    p -= (p + error - measured_px) / std::max(slope, kLeastSlope);
  }
  return p;
}

bool locks(const std::array<double, 4>& e) noexcept {
  return std::any_of(e.begin(), e.end(), [](double amplitude) { return amplitude != 0.0; });
}

}  // namespace

bool PointCorrection::corrects() const noexcept { return lens.calibrated() || locks(locking_px); }

Vector2 PointCorrection::corrected(const Vector2& ideal_px) const noexcept {
  Vector2 place = ideal_px;
  if (locks(locking_px)) place = {unlocked(place.u, locking_px), unlocked(place.v, locking_px)};
  return lens.calibrated() ? lens.undistort(place) : place;
}

}  // namespace core
