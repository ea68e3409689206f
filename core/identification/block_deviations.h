#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/types/cpsd.h"

namespace core {

// Effect of each part of a record on its correlations with the references.
struct BlockDeviations {
  int n_blocks = 0;  // 0: the record has fewer blocks than were asked for
  // Of a variance estimated from the blocks: n_blocks - 1, fewer if their weights differ (Satterthwaite).
  double degrees_of_freedom = 0.0;
  Eigen::MatrixXd value;  // (block, channel) x (lag, reference)
};

struct DeviationLags {
  int first = 1, n = 0;
  int n_differences = 0;  // as compute_correlations() took them
};

// The blocks in use, joined in order to n_groups parts as equal as can be: by how much each part moves
// R(channel, reference, lag) of Correlations::divided, to first order, (D_b - R M_b) / M, lag by lag, with the part's
// own sums D_b, M_b. Over all parts this adds up to zero.
[[nodiscard]] BlockDeviations block_deviations(const CpsdSums& sums, const std::vector<int>& references,
                                               const DeviationLags& lags, std::size_t n_groups);

}  // namespace core
