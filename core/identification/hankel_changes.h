#pragma once

#include <Eigen/Core>

#include "core/identification/block_deviations.h"
#include "core/identification/era.h"

namespace core {

// Lags that hankel_changes() needs of the deviations.
[[nodiscard]] DeviationLags hankel_change_lags(const EraConfig& config, int n_differences);
// Channels whose correlations with all others it needs: the references, then the inputs.
[[nodiscard]] std::vector<int> hankel_change_references(const EraConfig& config);

// dH d for every part of the record and every column d of `directions` (rows: block columns x references and inputs),
// with H the Hankel matrix from which the realisation was made, one block row longer than H0. With inputs
//   dH = [1, -B] dR [1; -K],   B = by_input, K = of_past,   to first order.
// Rows: (block row, output); columns: (part of the record, direction). Channels have unit variance.
[[nodiscard]] Eigen::MatrixXd hankel_changes(const Realisation& realisation, const EraConfig& config,
                                             const BlockDeviations& deviations, const Eigen::MatrixXd& directions);

}  // namespace core
