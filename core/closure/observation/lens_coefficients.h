#pragma once

#include <Eigen/Core>

#include "core/closure/observation/observation_record.h"

namespace core::closure {

// x_d = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y_d likewise with p1 (r^2 + 2 y^2) + 2 p2 x y
// (Brown 1971), r from the undistorted x, y about the principal point in units of the focal length.
struct LensCoefficients {
  double k1 = 0.0, k2 = 0.0, p1 = 0.0, p2 = 0.0, k3 = 0.0;

  LensCoefficients& operator+=(const LensCoefficients& o) noexcept {
    k1 += o.k1, k2 += o.k2, p1 += o.p1, p2 += o.p2, k3 += o.k3;
    return *this;
  }
  LensCoefficients& operator-=(const LensCoefficients& o) noexcept {
    k1 -= o.k1, k2 -= o.k2, p1 -= o.p1, p2 -= o.p2, k3 -= o.k3;
    return *this;
  }
  [[nodiscard]] bool none() const noexcept { return k1 == 0.0 && k2 == 0.0 && p1 == 0.0 && p2 == 0.0 && k3 == 0.0; }
};

// Undoes it on all positions (2 points x any, px), by fixed-point steps.
void undo_lens(const LensCoefficients& lens, const ObservationRecord& record, Eigen::MatrixXd& positions);

}  // namespace core::closure
