#pragma once

#include <Eigen/Core>

#include "core/identification/block_deviations.h"
#include "core/identification/era.h"

namespace core {

// Lags that hankel_changes() needs of the deviations.
[[nodiscard]] DeviationLags hankel_change_lags(const EraConfig& config, int n_differences);
// Channels whose correlations with all others it needs: the references, then the inputs.
[[nodiscard]] std::vector<int> hankel_change_references(const EraConfig& config);

// Samples of references and inputs in a row of the Hankel matrix that belongs to time 0: the lag of the latest one, and
// a value for each reference and input at each lag, ascending, for every column of `directions` (rows: block columns x
// references and inputs). With inputs: [d; -K d], K = of_past.
struct RowDirections {
  int first_lag = 0, n_lags = 0;
  Eigen::MatrixXd value;
};
[[nodiscard]] RowDirections row_directions(const Realisation& realisation, const EraConfig& config,
                                           const Eigen::MatrixXd& directions);

// dH d for every part of the record and every column d of `directions`, with H the Hankel matrix from which the
// realisation was made, one block row longer than H0. With inputs
//   dH = [1, -B] dR [1; -K],   B = by_input, K = of_past,   to first order;
// `inputs` is the part of dR [1; -K] d in the inputs' window. Columns: (part of the record, direction). Channels have
// unit variance.
struct HankelChanges {
  Eigen::MatrixXd outputs;  // rows: (block row, output)
  Eigen::MatrixXd inputs;   // rows: (sample, input)
};
[[nodiscard]] HankelChanges hankel_changes(const Realisation& realisation, const EraConfig& config,
                                           const BlockDeviations& deviations, const Eigen::MatrixXd& directions);

}  // namespace core
