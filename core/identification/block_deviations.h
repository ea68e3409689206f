#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/types/cpsd.h"

namespace core {

// Deviation of a record's correlations with the references, caused by each part of the record.
struct BlockDeviations {
  int n_blocks = 0;  // 0: the record has fewer blocks than requested
  // Degrees of freedom of a variance estimated from the blocks: n_blocks - 1, fewer if weights differ (Satterthwaite).
  double degrees_of_freedom = 0.0;
  Eigen::MatrixXd value;  // (block, channel) x (lag, reference)
};

struct DeviationLags {
  int first = 1, n = 0;
  int n_differences = 0;  // number of differences, as in compute_correlations()
};

// Joins the blocks in use, in order, to n_groups parts of nearly equal size and computes the change of R(channel,
// reference, lag) of Correlations::divided caused by each part: to first order (D_b - R M_b) / M, lag by lag, with the
// part's own sums D_b, M_b. The changes of all parts add up to zero.
[[nodiscard]] BlockDeviations block_deviations(const CpsdSums& sums, const std::vector<int>& references,
                                               const DeviationLags& lags, std::size_t n_groups);

}  // namespace core
