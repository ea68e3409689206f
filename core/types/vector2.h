#pragma once

#include <cmath>

namespace core {

// A point or a step in the image, pixels; u right, v down.
struct Vector2 {
  double u = 0.0;
  double v = 0.0;
};

// Uses only operations that IEEE 754 rounds exactly: bit-identical on every machine, unlike std::hypot.
[[nodiscard]] inline double length(double u, double v) noexcept { return std::sqrt(u * u + v * v); }
[[nodiscard]] inline double length(const Vector2& a) noexcept { return length(a.u, a.v); }

}  // namespace core
