#include "core/identification/hankel_changes.h"

#include "core/identification/given_inputs.h"
#include "core/linear/dense.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

// Deviations times directions: a direction is a value for each reference at each time, latest time first, as lags
// ascend.
class Products {
 public:
  Products(const Realisation& realisation, const EraConfig& config, const BlockDeviations& deviations)
      : n_channels_(realisation.scale.size()), n_blocks_(deviations.n_blocks), value_(deviations.value) {
    const std::vector<int> references = hankel_change_references(config);
    n_references_ = static_cast<Index>(references.size());
    for (Index r = 0; r < value_.rows(); ++r) value_.row(r) /= realisation.scale[r % n_channels_];
    for (Index c = 0; c < value_.cols(); ++c) {
      value_.col(c) /= realisation.scale[references[static_cast<std::size_t>(c % n_references_)]];
    }
  }

  // Rows: (part, channel). `step`: the row's time after the first one that the deviations reach.
  [[nodiscard]] MatrixXd at(Index step, const MatrixXd& directions) const {
    MatrixXd out = MatrixXd::Zero(value_.rows(), directions.cols());
    add_product(out, 1.0, value_.middleCols(step * n_references_, directions.rows()), directions);
    return out;
  }

  // Copies the rows of `channels` of every part into block row a.
  void write(const MatrixXd& products, const std::vector<int>& channels, Index a, MatrixXd& out) const {
    const auto n = static_cast<Index>(channels.size()), width = products.cols();
    for (Index block = 0; block < n_blocks_; ++block) {
      for (Index i = 0; i < n; ++i) {
        out.row(a * n + i).segment(block * width, width) =
            products.row(block * n_channels_ + channels[static_cast<std::size_t>(i)]);
      }
    }
  }

 private:
  Index n_channels_, n_references_ = 0, n_blocks_;
  MatrixXd value_;
};

}  // namespace

std::vector<int> hankel_change_references(const EraConfig& config) {
  std::vector<int> out = config.references;
  out.insert(out.end(), config.inputs.begin(), config.inputs.end());
  return out;
}

DeviationLags hankel_change_lags(const EraConfig& config, int n_differences) {
  const int p = config.block_rows;
  if (config.inputs.empty()) return {config.first_lag, 2 * p, n_differences};
  // From the inputs' first sample after its own last one to the outputs' last one after the past's first.
  const int first = -(p + 2 * input_margin(config));
  return {first, furthest_lag(config) - first, n_differences};
}

RowDirections row_directions(const Realisation& realisation, const EraConfig& config, const MatrixXd& directions) {
  if (config.inputs.empty()) return {config.first_lag, config.block_rows, directions};
  // By time, latest first: the inputs' window ends after the past, and the two overlap.
  const GivenInputs samples = given_inputs(config, static_cast<int>(realisation.scale.size()));
  const auto n_all = static_cast<Index>(samples.past.channels.size()),
             n_inputs = static_cast<Index>(samples.input.channels.size());
  const int latest = samples.input.time(samples.input.n - 1), earliest = samples.past.time(samples.past.n - 1);
  MatrixXd explained = MatrixXd::Zero(samples.input.size(), directions.cols());
  add_product(explained, -1.0, realisation.of_past, directions);
  RowDirections out{-latest, latest - earliest + 1, {}};
  out.value = MatrixXd::Zero(out.n_lags * n_all, directions.cols());
  for (int k = 0; k < samples.past.n; ++k) {
    out.value.middleRows((latest - samples.past.time(k)) * n_all, n_all) += directions.middleRows(k * n_all, n_all);
  }
  for (int k = 0; k < samples.input.n; ++k) {
    const Index row = (latest - samples.input.time(k)) * n_all + n_all - n_inputs;
    out.value.middleRows(row, n_inputs) += explained.middleRows(k * n_inputs, n_inputs);
  }
  return out;
}

HankelChanges hankel_changes(const Realisation& realisation, const EraConfig& config, const BlockDeviations& deviations,
                             const MatrixXd& directions) {
  const Products products(realisation, config, deviations);
  const GivenInputs samples = given_inputs(config, static_cast<int>(realisation.scale.size()));
  const bool given = !config.inputs.empty();
  const MatrixXd row = row_directions(realisation, config, directions).value;
  const Index margin = given ? input_margin(config) : 0, n_columns = deviations.n_blocks * directions.cols();
  HankelChanges out;
  out.outputs.resize(samples.future.size(), n_columns);
  out.inputs.resize(given ? samples.input.size() : 0, n_columns);
  for (Index step = 0; step < samples.future.n + 2 * margin; ++step) {
    const MatrixXd changes = products.at(step, row);
    const Index a = step - margin;
    if (a >= 0 && a < samples.future.n) products.write(changes, samples.future.channels, a, out.outputs);
    if (given) products.write(changes, config.inputs, step, out.inputs);
  }
  if (given) add_product(out.outputs, -1.0, realisation.by_input, out.inputs);
  return out;
}

}  // namespace core
