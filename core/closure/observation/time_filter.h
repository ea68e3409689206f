#pragma once

#include <Eigen/Core>

namespace core::closure {

// Low band of series over frames, as a projection.

// Orthonormal cosines (DCT-II) over n frames, frames x count: those up to limit_hz, the constant included. Projection
// on them is a zero-phase low-pass that does not assume a periodic record.
[[nodiscard]] Eigen::MatrixXd low_cosines(Eigen::Index n_frames, double rate_hz, double limit_hz);

// values * cosines for cosines of low_cosines(); even and odd symmetry about the middle halves the work.
[[nodiscard]] Eigen::MatrixXd low_amplitudes(const Eigen::MatrixXd& values, const Eigen::MatrixXd& cosines);

}  // namespace core::closure
