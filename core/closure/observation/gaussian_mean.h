#pragma once

#include <Eigen/Core>

namespace core::closure {

// Mean over neighbouring values with Gaussian weights; sigma: in values. Beyond the ends there are none.
[[nodiscard]] Eigen::RowVectorXd gaussian_mean(const Eigen::RowVectorXd& values, double sigma);

}  // namespace core::closure
