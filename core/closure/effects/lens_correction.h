#pragma once

#include <Eigen/Core>

#include "core/closure/effects/observation_effect.h"

namespace core::closure {

// Undoes x_d = x (1 + k1 r^2) + 2 p1 x y + p2 (r^2 + 2 x^2), y_d = y (1 + k1 r^2) + p1 (r^2 + 2 y^2) + 2 p2 x y (Brown
// 1971) on all positions, by fixed-point steps.
void undo_lens(double k1, double p1, double p2, const CorrectionView& view, Eigen::MatrixXd& positions);

}  // namespace core::closure
