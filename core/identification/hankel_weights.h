#pragma once

#include <Eigen/Core>

#include "core/identification/era.h"

namespace core {

// For unit-variance channels. Larger values suppress the weakest mode; with smaller ones Cholesky fails (METHOD.md).
inline constexpr double kLeastRidge = 1e-6;
inline constexpr double kMostRidge = 1.0;

// Lower Cholesky factors of the block Toeplitz covariances of future and past, each with the smallest ridge (1e-6, then
// ten times more) that makes it positive definite.
struct HankelWeights {
  Eigen::MatrixXd left, right;
};

// Standard deviation of each channel.
[[nodiscard]] Eigen::VectorXd channel_scale(const Correlations& correlations);

// Factors [T; B] (core/linear/dense.h: factor_stacked) with the smallest sufficient ridge; false if none suffices.
[[nodiscard]] bool factor_with_ridge(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& below,
                                     Eigen::MatrixXd& out);

[[nodiscard]] Eigen::MatrixXd future_covariance(const Correlations& correlations, const EraConfig& config,
                                                const Eigen::VectorXd& scale);
[[nodiscard]] Eigen::MatrixXd past_covariance(const Correlations& correlations, const EraConfig& config,
                                              const Eigen::VectorXd& scale);

[[nodiscard]] bool hankel_weights(const Correlations& correlations, const EraConfig& config,
                                  const Eigen::VectorXd& scale, HankelWeights& out);

// The order of the realisation: the requested one, limited by the nonzero singular values (descending).
[[nodiscard]] Eigen::Index wanted_order(const EraConfig& config, const Eigen::VectorXd& singular_values);

}  // namespace core
