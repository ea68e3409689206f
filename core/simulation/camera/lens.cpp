#include "core/simulation/camera/lens.h"

#include <cmath>

namespace core::simulation {
namespace {

Ray radial_tangential(const LensParameters& lens, Ray p) noexcept {
  const auto& [k1, k2, p1, p2, k3] = lens.k;
  const double r2 = p.x * p.x + p.y * p.y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {p.x * radial + 2.0 * p1 * p.x * p.y + p2 * (r2 + 2.0 * p.x * p.x),
          p.y * radial + p1 * (r2 + 2.0 * p.y * p.y) + 2.0 * p2 * p.x * p.y};
}

Ray equidistant(const LensParameters& lens, Ray p) noexcept {
  const double r = std::hypot(p.x, p.y);
  if (r < 1e-12) return p;
  const double theta = std::atan(r), t2 = theta * theta;
  const double bent = theta * (1.0 + t2 * (lens.k[0] + t2 * (lens.k[1] + t2 * (lens.k[2] + t2 * lens.k[3]))));
  return {p.x * bent / r, p.y * bent / r};
}

}  // namespace

Ray distort(const LensParameters& lens, Ray ideal) noexcept {
  switch (lens.model) {
    case LensParameters::Model::kRadialTangential:
      return radial_tangential(lens, ideal);
    case LensParameters::Model::kEquidistant:
      return equidistant(lens, ideal);
    case LensParameters::Model::kNone:
      break;
  }
  return ideal;
}

Ray undistort(const LensParameters& lens, Ray seen) noexcept {
  if (lens.model == LensParameters::Model::kNone) return seen;
  constexpr int kRounds = 30;
  constexpr double kStep = 1e-6;
  Ray ray = seen;
  for (int i = 0; i < kRounds; ++i) {
    const Ray at = distort(lens, ray);
    const double error_x = seen.x - at.x, error_y = seen.y - at.y;
    if (std::abs(error_x) + std::abs(error_y) < 1e-13) break;
    const Ray right = distort(lens, {ray.x + kStep, ray.y}), left = distort(lens, {ray.x - kStep, ray.y});
    const Ray below = distort(lens, {ray.x, ray.y + kStep}), above = distort(lens, {ray.x, ray.y - kStep});
    const double a = (right.x - left.x) / (2 * kStep), b = (below.x - above.x) / (2 * kStep);
    const double c = (right.y - left.y) / (2 * kStep), d = (below.y - above.y) / (2 * kStep);
    const double determinant = a * d - b * c;
    if (!(std::abs(determinant) > 1e-3)) break;
    ray.x += (d * error_x - b * error_y) / determinant;
    ray.y += (a * error_y - c * error_x) / determinant;
  }
  return ray;
}

}  // namespace core::simulation
