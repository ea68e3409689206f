#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/closure/observation/point_correlation.h"

namespace core::closure {

// Correlation of the noise of points of one region, from what a fit in each frame leaves of their series (2 points x
// frames, in sigmas): the covariances between them above from_hz are fitted by least squares with shares that are not
// negative, as the median over eight bands, so that a line or a resonance does not count as noise. What the fit takes
// and passes on is part of the fit (minimum norm quadratic estimation, Rao 1971). removal: matrix that turns noise of
// unit variance into its residual. Shares that the fit removes (of a region that moves freely) are 0.
[[nodiscard]] CorrelationShares noise_correlation(const Eigen::MatrixXd& residual, const Eigen::MatrixXd& removal,
                                                  const std::vector<std::size_t>& region_of_point,
                                                  const Eigen::VectorXd& places_px, double rate_hz, double from_hz);

}  // namespace core::closure
