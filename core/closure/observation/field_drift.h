#pragma once

#include <Eigen/Core>

#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// Velocity at which a displacement field passes over the points ("frozen flow", Taylor 1938), in px/s.
struct FieldDrift {
  double u_px_s = 0.0, v_px_s = 0.0;
  double sigma_px_s = 0.0;  // half a step of the grid
  // Likeness of the antisymmetric parts of the covariances between points at different times with those of a field that
  // moves so: about 0 for a static one, 1 at most.
  double likeness = 0.0;
};

// field_px: 2 points x frames. Compared are the covariances between points (80 at most) at lags of 0.1 to 1 s with
// those of a field that moves, for lengths of 15 to 240 px and speeds of 5 to 450 px/s. The length is free: the motions
// that a fit removes from the field shorten its covariances.
[[nodiscard]] FieldDrift field_drift(const Eigen::MatrixXd& field_px, const PointGeometry& geometry, double rate_hz);

}  // namespace core::closure
