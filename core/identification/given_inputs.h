#pragma once

#include <Eigen/Core>

#include "core/identification/block_covariance.h"
#include "core/identification/era.h"

namespace core {

// Samples about the present, 0, of a realisation whose inputs are measured (EraConfig::inputs). The outputs' future has
// one block row more than H0, because H1 is the same matrix without its first. The inputs' future is longer by
// input_margin() samples at either end: a rolling shutter reads a base earlier or later than the structure, and the
// motion between two samples, which folded modes follow, shows in the samples on both sides.
[[nodiscard]] int input_margin(const EraConfig& config) noexcept;  // <= block rows

struct GivenInputs {
  SampleWindow future, past, input;
};
[[nodiscard]] GivenInputs given_inputs(const EraConfig& config, int n_channels);

// Furthest lag between any two of these samples.
[[nodiscard]] int furthest_lag(const EraConfig& config) noexcept;

// What is left of the outputs' future and of the past once the input explains its part (linear regression on all
// samples of the input's window; Verhaegen 1994, PO-MOESP): E[y z^T | u] = R_yz - R_yu R_uu^-1 R_uz.
struct ConditionedHankel {
  Eigen::MatrixXd hankel;             // (block rows + 1) x block columns, of the divided correlations
  Eigen::MatrixXd future, past;       // covariances, of the undivided ones; block rows and block columns
  Eigen::MatrixXd by_input, of_past;  // R_yu R_uu^-1 and R_uu^-1 R_uz, of the divided correlations
};

// False if the input's covariance cannot be factored.
[[nodiscard]] bool condition_on_inputs(const Correlations& correlations, const EraConfig& config,
                                       const Eigen::VectorXd& scale, ConditionedHankel& out);

}  // namespace core
