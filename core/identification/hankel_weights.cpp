#include "core/identification/hankel_weights.h"

#include <algorithm>
#include <numeric>

#include "core/identification/block_hankel.h"
#include "core/linear/dense.h"

namespace core {

using Eigen::MatrixXd;

Eigen::VectorXd channel_scale(const Correlations& correlations) {
  Eigen::VectorXd scale(correlations.n_channels());
  for (int i = 0; i < scale.size(); ++i) scale[i] = std::sqrt(correlations.undivided(i, i, 0));
  return scale;
}

bool factor_with_ridge(const MatrixXd& covariance, const MatrixXd& below, MatrixXd& out) {
  for (double ridge = kLeastRidge; ridge < kMostRidge; ridge *= 10.0) {
    out.resize(covariance.rows() + below.rows(), covariance.cols());
    out.topRows(covariance.rows()) = covariance;
    out.bottomRows(below.rows()) = below;
    out.diagonal().array() += ridge;
    if (factor_stacked(out)) return true;
  }
  return false;
}

MatrixXd future_covariance(const Correlations& correlations, const EraConfig& config, const Eigen::VectorXd& scale) {
  std::vector<int> outputs(static_cast<std::size_t>(correlations.n_channels()));
  std::iota(outputs.begin(), outputs.end(), 0);
  return block_toeplitz(correlations, outputs, scale, config.block_rows, false);
}

MatrixXd past_covariance(const Correlations& correlations, const EraConfig& config, const Eigen::VectorXd& scale) {
  return block_toeplitz(correlations, config.references, scale, config.block_rows, true);
}

bool hankel_weights(const Correlations& correlations, const EraConfig& config, const Eigen::VectorXd& scale,
                    HankelWeights& out) {
  const MatrixXd future = future_covariance(correlations, config, scale);
  const MatrixXd past = past_covariance(correlations, config, scale);
  return factor_with_ridge(future, MatrixXd(0, future.cols()), out.left) &&
         factor_with_ridge(past, MatrixXd(0, past.cols()), out.right);
}

Eigen::Index wanted_order(const EraConfig& config, const Eigen::VectorXd& singular_values) {
  Eigen::Index order = std::min<Eigen::Index>(config.max_order, singular_values.size());
  if (config.above_canonical > 0) {
    order = std::min<Eigen::Index>(order, std::max(2, canonical_order(singular_values)) + config.above_canonical);
  }
  while (order > 0 && !(singular_values[order - 1] > 1e-12 * singular_values[0])) --order;
  return order;
}

}  // namespace core
