#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/correlation.h"

namespace core {

// H^T H of the block Hankel matrix H with one block column more than H0 (block_hankel.h): H0^T H0 is its part without
// the last block row and column, H0^T H1 its part without the last block row and the first block column. H is not
// formed: block (b + 1, c + 1) of H^T H is block (b, c) minus the product of H's first block row, plus the product of
// the block row that follows its last.
[[nodiscard]] Eigen::MatrixXd hankel_gram(const Correlations& correlations, const std::vector<int>& references,
                                          const Eigen::VectorXd& scale, int n_blocks, int first_lag);

}  // namespace core
