#pragma once

#include <Eigen/Core>

#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// Share of a field's squares (2 points long) explained by 1, x, y (and x^2, xy, y^2 if quadratic), along u and v
// separately.
[[nodiscard]] double smooth_share(const Eigen::VectorXd& field, const PointGeometry& geometry, bool quadratic);

}  // namespace core::closure
