#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/correlation.h"

namespace core {

// Block Hankel matrix of R, block (a, b) = R(first_lag + a + b) (outputs x references), and its shift by one lag.
// Channels are divided by `scale` first, so that each has unit variance.
// rows: block_rows * n_outputs, columns: block_columns * n_references.
[[nodiscard]] Eigen::MatrixXd block_hankel(const Correlations& correlations, const std::vector<int>& references,
                                           const Eigen::VectorXd& scale, int block_rows, int block_columns,
                                           int first_lag);

// Block Toeplitz covariance of `n_blocks` successive samples of `channels`, from the undivided (positive semidefinite)
// estimate: block (a, a') = R(a - a') for samples in future order, R(a' - a) in past order.
[[nodiscard]] Eigen::MatrixXd block_toeplitz(const Correlations& correlations, const std::vector<int>& channels,
                                             const Eigen::VectorXd& scale, int n_blocks, bool past_order);

}  // namespace core
