#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

namespace core {

// Damping of Levenberg-Marquardt: 0 is Gauss-Newton, large a short step down the scaled gradient.
struct Damping {
  double value = 1e-3;
  double least = 1e-9;
  double most = 1e6;  // no step is tried at or above it
};

// One step of Levenberg-Marquardt with Marquardt's scaling (Marquardt 1963; Nocedal & Wright, 10.3):
//   (H + damping diag H) step = -gradient,   H: n x n, positive semidefinite (J' J), gradient: of half the squares, J'
//   r.
// `lowers(step)` evaluates the cost there and, where it is lower, moves there and returns true; else the damping grows
// tenfold and a shorter step is tried. An accepted step divides the damping by ten. Returns whether one was accepted. A
// step that is not finite (H singular) is never offered. Fixed-size matrices: nothing allocates.
template <class Matrix, class Vector, class Lowers>
[[nodiscard]] bool damped_step(const Matrix& hessian, const Vector& gradient, Damping& damping, Lowers&& lowers) {
  for (; damping.value < damping.most; damping.value *= 10.0) {
    Matrix raised = hessian;
    raised.diagonal() *= 1.0 + damping.value;
    const Vector step = -raised.ldlt().solve(gradient);
    if (!step.allFinite() || !lowers(step)) continue;
    damping.value = std::max(damping.least, 0.1 * damping.value);
    return true;
  }
  return false;
}

}  // namespace core
