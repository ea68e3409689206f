#pragma once

#include "core/simulation/scene.h"

namespace core::simulation {

struct Ray {
  double x = 0.0, y = 0.0;  // X / Z, Y / Z
};

// Where the lens shows an ideal ray. Exact; written apart from core/geometry, which it tests.
[[nodiscard]] Ray distort(const LensParameters& lens, Ray ideal) noexcept;
// The inverse, by Newton's method to 1e-13; where the lens folds over (far outside a sensible image), the nearest it
// got.
[[nodiscard]] Ray undistort(const LensParameters& lens, Ray seen) noexcept;

}  // namespace core::simulation
