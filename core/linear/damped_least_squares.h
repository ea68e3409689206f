#pragma once

#include <Eigen/Cholesky>
#include <algorithm>

namespace core {

// Damping of Levenberg-Marquardt: 0 is Gauss-Newton; large values give short steps along the scaled gradient.
struct Damping {
  double value = 1e-3;
  double least = 1e-9;
  double most = 1e6;  // steps are tried only below this damping
};

// One step of Levenberg-Marquardt with Marquardt's scaling (Marquardt 1963; Nocedal & Wright, 10.3):
//   (H + damping diag H) step = -gradient,  H = J' J: n x n, positive semidefinite, gradient: of half the squares, J'
//   r.
// `lowers(step)` evaluates the cost at the step; if it is lower, it applies the step and returns true. Otherwise the
// damping increases tenfold and a shorter step is tried. An accepted step divides the damping by ten. Returns true if a
// step was accepted. A step that is not finite (H singular) is not evaluated. With fixed-size matrices it does not
// allocate.
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
