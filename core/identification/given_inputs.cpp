#include "core/identification/given_inputs.h"

#include <algorithm>

#include "core/identification/hankel_weights.h"
#include "core/linear/dense.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

struct Regressed {
  MatrixXd factor;            // L, R_uu = L L^T
  MatrixXd future_u, past_u;  // R_yu L^-T, R_zu L^-T
};

bool regress(const Correlations& correlations, const Eigen::VectorXd& scale, const GivenInputs& samples, Estimate kind,
             Regressed& out) {
  const auto covariance = [&](const SampleWindow& rows, const SampleWindow& columns) {
    return block_covariance(correlations, scale, rows, columns, kind);
  };
  const Index n_u = samples.input.size(), n_y = samples.future.size(), n_z = samples.past.size();
  MatrixXd below(n_y + n_z, n_u), stacked;
  below << covariance(samples.future, samples.input), covariance(samples.past, samples.input);
  if (!below.allFinite() || !factor_with_ridge(covariance(samples.input, samples.input), below, stacked)) return false;
  out.factor = stacked.topRows(n_u);
  out.future_u = stacked.middleRows(n_u, n_y);
  out.past_u = stacked.bottomRows(n_z);
  return true;
}

void subtract_product(MatrixXd& from, const MatrixXd& a, const MatrixXd& b) {
  add_product_transposed(from, -1.0, a, b);
}

}  // namespace

int input_margin(const EraConfig& config) noexcept {
  constexpr int kMargin = 8;
  return std::min(kMargin, config.block_rows);
}

GivenInputs given_inputs(const EraConfig& config, int n_channels) {
  const int p = config.block_rows;
  GivenInputs out;
  for (int c = 0; c < n_channels; ++c) {
    if (std::find(config.inputs.begin(), config.inputs.end(), c) == config.inputs.end())
      out.future.channels.push_back(c);
  }
  out.future.n = p + 1;
  out.past.channels = config.references;
  out.past.channels.insert(out.past.channels.end(), config.inputs.begin(), config.inputs.end());
  out.past.first = -config.first_lag, out.past.n = p, out.past.step = -1;
  out.input.channels = config.inputs;
  out.input.first = -input_margin(config), out.input.n = p + 1 + 2 * input_margin(config);
  return out;
}

int furthest_lag(const EraConfig& config) noexcept {
  return 2 * config.block_rows + config.first_lag + (config.inputs.empty() ? 0 : input_margin(config));
}

bool condition_on_inputs(const Correlations& correlations, const EraConfig& config, const Eigen::VectorXd& scale,
                         ConditionedHankel& out) {
  GivenInputs samples = given_inputs(config, correlations.n_channels());
  Regressed by;
  if (!regress(correlations, scale, samples, Estimate::kDivided, by)) return false;
  out.hankel = block_covariance(correlations, scale, samples.future, samples.past, Estimate::kDivided);
  subtract_product(out.hankel, by.future_u, by.past_u);
  divide_by_lower(by.future_u, by.factor);
  divide_by_lower(by.past_u, by.factor);
  out.by_input = by.future_u;
  out.of_past = by.past_u.transpose();

  samples.future.n = config.block_rows;
  if (!regress(correlations, scale, samples, Estimate::kUndivided, by)) return false;
  out.future = block_covariance(correlations, scale, samples.future, samples.future, Estimate::kUndivided);
  out.past = block_covariance(correlations, scale, samples.past, samples.past, Estimate::kUndivided);
  subtract_product(out.future, by.future_u, by.future_u);
  subtract_product(out.past, by.past_u, by.past_u);
  return out.hankel.allFinite();
}

}  // namespace core
