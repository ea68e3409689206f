#pragma once

#include <cstddef>
#include <vector>

namespace core::simulation {

// Cubic B-spline through uniform samples, mirrored at both ends (Unser, Splines: a perfect fit for signal and image
// processing, 1999). Twice continuously differentiable everywhere; through every sample; beyond the ends it runs back
// the way it came, x(T + t) = x(T - t), for ever: position continuous, velocity zero at the ends, where it turns.
// A sine of n samples per cycle is met, away from the ends, to about (2 pi / n)^4 / 384 of its amplitude: 2.5 % at 4
// samples, 1.2e-3 at 8, 6.5e-5 at 16, 2.6e-5 at 20. Within two samples of an end the turning costs up to
// 0.2 (2 pi / n) of it.
class UniformSpline {
 public:
  UniformSpline() = default;                                          // zero everywhere
  UniformSpline(const std::vector<double>& samples, double rate_hz);  // at least 4 samples

  [[nodiscard]] double at(double t_s) const noexcept;  // sample k lies at k / rate; 0 for a t that is not finite

 private:
  [[nodiscard]] double coefficient(std::ptrdiff_t i) const noexcept;

  std::vector<double> coefficient_;
  double rate_hz_ = 0.0;
};

}  // namespace core::simulation
