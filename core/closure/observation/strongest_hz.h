#pragma once

#include <Eigen/Core>

namespace core::closure {

// Frequency at which a series is strongest, summed over neighbouring bins.
[[nodiscard]] double strongest_hz(const Eigen::RowVectorXd& series, double rate_hz);

}  // namespace core::closure
