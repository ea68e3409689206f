#pragma once

#include <Eigen/Core>

namespace core::closure {

// Noise of each point from what a fit in each frame leaves of its series (2 points x frames): the level of its spectrum
// above from_hz, as the median over the frequencies, so that a line, a band or a resonance does not count as noise; and
// without what the fit takes from each point and passes on from the others (minimum norm quadratic estimation, Rao
// 1971). q: the fit's orthonormal columns. Standard deviations in the unit of the residual; 1 where a point's own noise
// does not reach the residual.
[[nodiscard]] Eigen::VectorXd point_noise(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& q, double rate_hz,
                                          double from_hz);

}  // namespace core::closure
