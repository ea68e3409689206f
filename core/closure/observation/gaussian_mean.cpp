#include "core/closure/observation/gaussian_mean.h"

#include <algorithm>
#include <cmath>

namespace core::closure {

Eigen::RowVectorXd gaussian_mean(const Eigen::RowVectorXd& values, double sigma) {
  constexpr double kReachSigmas = 3.0;
  const Eigen::Index n = values.size(),
                     reach = std::min(static_cast<Eigen::Index>(std::ceil(kReachSigmas * sigma)), n - 1);
  Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(n), weights = sum;
  for (Eigen::Index lag = -reach; lag <= reach; ++lag) {
    const Eigen::Index to = std::max<Eigen::Index>(-lag, 0), from = std::max<Eigen::Index>(lag, 0),
                       count = n - std::abs(lag);
    const double weight = std::exp(-0.5 * std::pow(static_cast<double>(lag) / sigma, 2));
    sum.segment(to, count) += weight * values.segment(from, count);
    weights.segment(to, count).array() += weight;
  }
  return sum.cwiseQuotient(weights);
}

}  // namespace core::closure
