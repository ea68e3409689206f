#pragma once

#include <Eigen/Core>
#include <vector>

namespace core::closure {

// Linear-phase filters over frames by windowed sincs (Kaiser's window), and a low band as a projection.

// Taps 0 .. half of the filter that passes up to `cutoff` (cycles per frame, at most 0.5); the rest by symmetry
// (smoother: even, derivative: odd). Derivatives are per frame.
[[nodiscard]] std::vector<double> smoother_taps(double cutoff, int half);
[[nodiscard]] std::vector<double> derivative_taps(double cutoff, int half);

// Rows of `series` are series over frames. Ends are continued by reflection in the end point, which keeps value and
// slope; results there are less accurate.
[[nodiscard]] Eigen::MatrixXd filter_even(const Eigen::MatrixXd& series, const std::vector<double>& taps);
[[nodiscard]] Eigen::MatrixXd filter_odd(const Eigen::MatrixXd& series, const std::vector<double>& taps);

// Orthonormal cosines (DCT-II) over n frames, frames x count: those up to limit_hz, the constant included. Projection
// on them is a low-pass without phase that does not assume a periodic record.
[[nodiscard]] Eigen::MatrixXd low_cosines(Eigen::Index n_frames, double rate_hz, double limit_hz);

// values * cosines for cosines of low_cosines(); half the work, as they are even or odd about the middle.
[[nodiscard]] Eigen::MatrixXd low_amplitudes(const Eigen::MatrixXd& values, const Eigen::MatrixXd& cosines);

}  // namespace core::closure
