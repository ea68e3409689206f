#pragma once

#include "core/simulation/scene.h"

namespace core::simulation {

struct Ray {
  double x = 0.0, y = 0.0;  // X / Z, Y / Z
};

// Distorts an ideal ray. Exact; independent of core/geometry, which it tests.
[[nodiscard]] Ray distort(const LensParameters& lens, Ray ideal) noexcept;
// The inverse, by Newton's method to 1e-13; if the lens folds (far outside a sensible image), the nearest
// iterate.
[[nodiscard]] Ray undistort(const LensParameters& lens, Ray seen) noexcept;

}  // namespace core::simulation
