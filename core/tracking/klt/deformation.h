#pragma once

#include <array>

#include "core/types/vector2.h"

namespace core {

// Deformation of the image about a point since its template was cut: a feature at offset x from the point is now at
// offset (1 + A) x. To first order it contains magnification, roll, rolling-shutter shear and perspective.
struct Deformation {
  double uu = 0.0, uv = 0.0, vu = 0.0, vv = 0.0;  // A by rows: d(du)/du, d(du)/dv; d(dv)/du, d(dv)/dv

  // A x.
  [[nodiscard]] Vector2 of(const Vector2& x) const noexcept { return {uu * x.u + uv * x.v, vu * x.u + vv * x.v}; }
  [[nodiscard]] std::array<double, 4> elements() const noexcept { return {uu, uv, vu, vv}; }
};
[[nodiscard]] inline Deformation operator+(const Deformation& a, const Deformation& b) noexcept {
  return {a.uu + b.uu, a.uv + b.uv, a.vu + b.vu, a.vv + b.vv};
}
[[nodiscard]] inline Deformation operator-(const Deformation& a, const Deformation& b) noexcept {
  return {a.uu - b.uu, a.uv - b.uv, a.vu - b.vu, a.vv - b.vv};
}
[[nodiscard]] inline Deformation operator*(double factor, const Deformation& a) noexcept {
  return {factor * a.uu, factor * a.uv, factor * a.vu, factor * a.vv};
}

// Effect of an image deformation on the match with a template that is only shifted, from the template alone
// (METHOD.md).

// Offset at which the template is found, px per unit of each element: it is not zero, because texture is not symmetric
// about the point.
using DeformationPull = std::array<Vector2, 4>;
[[nodiscard]] inline Vector2 offset_by(const DeformationPull& pull, const Deformation& a) noexcept {
  const auto e = a.elements();
  return {(e[0] * pull[0].u + e[1] * pull[1].u) + (e[2] * pull[2].u + e[3] * pull[3].u),
          (e[0] * pull[0].v + e[1] * pull[1].v) + (e[2] * pull[2].v + e[3] * pull[3].v)};
}

// Quadratic form of the residual caused by deformation, grey^2 summed over the window: rows of its upper triangle,
// off-diagonal elements doubled.
using DeformationEnergy = std::array<double, 10>;
[[nodiscard]] inline double energy_of(const DeformationEnergy& energy, const Deformation& a) noexcept {
  const auto e = a.elements();
  double sum = 0.0;
  for (std::size_t k = 0, at = 0; k < 4; ++k)
    for (std::size_t l = k; l < 4; ++l) sum += energy[at++] * e[k] * e[l];
  return sum;
}

}  // namespace core
