#pragma once

#include <cstddef>
#include <vector>

namespace core::simulation {

// Cubic B-spline through uniform samples, mirrored at both ends (Unser, Splines: a perfect fit for signal and image
// processing, 1999). Twice continuously differentiable; passes through every sample. Beyond the ends it is mirrored
// in time, x(T + t) = x(T - t), periodically: position continuous, velocity zero at the ends. A sine of n samples
// per cycle is reproduced, away from the ends, to about (2 pi / n)^4 / 384 of its amplitude: 2.5 % at 4 samples,
// 1.2e-3 at 8, 6.5e-5 at 16, 2.6e-5 at 20. Within two samples of an end the error is up to 0.2 (2 pi / n) of the
// amplitude.
class UniformSpline {
 public:
  UniformSpline() = default;                                          // zero everywhere
  UniformSpline(const std::vector<double>& samples, double rate_hz);  // at least 4 samples

  [[nodiscard]] double at(double t_s) const noexcept;  // sample k is at k / rate; 0 if t is not finite

 private:
  [[nodiscard]] double coefficient(std::ptrdiff_t i) const noexcept;

  std::vector<double> coefficient_;
  double rate_hz_ = 0.0;
};

}  // namespace core::simulation
