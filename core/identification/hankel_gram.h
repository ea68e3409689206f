#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/identification/correlation.h"

namespace core {

// H0^T H0 and H0^T H1 of a block Hankel matrix (block_hankel.h) and of its shift by one lag, without forming either:
// with H = [H0, last block column of H1] and G = H^T H, block (b + 1, c + 1) of G is block (b, c) less the product of
// the first block row plus that of the row behind the last.
struct HankelGram {
  Eigen::MatrixXd own;      // H0^T H0
  Eigen::MatrixXd shifted;  // H0^T H1
};

[[nodiscard]] HankelGram hankel_gram(const Correlations& correlations, const std::vector<int>& references,
                                     const Eigen::VectorXd& scale, int n_blocks, int first_lag);

}  // namespace core
