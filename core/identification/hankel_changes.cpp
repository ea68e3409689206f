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

// [d; -K d] by time, latest first: the inputs' window ends after the past, and the two overlap.
MatrixXd joint_directions(const Realisation& realisation, const GivenInputs& samples, const MatrixXd& directions) {
  const auto n_all = static_cast<Index>(samples.past.channels.size()),
             n_inputs = static_cast<Index>(samples.input.channels.size());
  const int latest = samples.input.time(samples.input.n - 1), earliest = samples.past.time(samples.past.n - 1);
  MatrixXd explained = MatrixXd::Zero(samples.input.size(), directions.cols());
  add_product(explained, -1.0, realisation.of_past, directions);
  MatrixXd out = MatrixXd::Zero((latest - earliest + 1) * n_all, directions.cols());
  for (int k = 0; k < samples.past.n; ++k) {
    out.middleRows((latest - samples.past.time(k)) * n_all, n_all) += directions.middleRows(k * n_all, n_all);
  }
  for (int k = 0; k < samples.input.n; ++k) {
    const Index row = (latest - samples.input.time(k)) * n_all + n_all - n_inputs;
    out.middleRows(row, n_inputs) += explained.middleRows(k * n_inputs, n_inputs);
  }
  return out;
}

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
  const int first = -(p + 2 * kInputMargin);
  return {first, furthest_lag(config) - first, n_differences};
}

MatrixXd hankel_changes(const Realisation& realisation, const EraConfig& config, const BlockDeviations& deviations,
                        const MatrixXd& directions) {
  const Products products(realisation, config, deviations);
  const GivenInputs samples = given_inputs(config, static_cast<int>(realisation.scale.size()));
  const std::vector<int>& outputs = samples.future.channels;
  const auto ny = static_cast<Index>(outputs.size());
  const bool given = !config.inputs.empty();
  const MatrixXd joint = given ? joint_directions(realisation, samples, directions) : directions;
  const Index margin = given ? kInputMargin : 0, n_columns = deviations.n_blocks * directions.cols();
  MatrixXd out(samples.future.n * ny, n_columns), by_input(samples.input.size(), n_columns);
  const Index n_steps = samples.future.n + 2 * margin;
  for (Index step = 0; step < n_steps; ++step) {
    const MatrixXd y = products.at(step, joint);
    const Index a = step - margin;
    if (a >= 0 && a < samples.future.n) products.write(y, outputs, a, out);
    if (given) products.write(y, config.inputs, step, by_input);
  }
  if (given) add_product(out, -1.0, realisation.by_input, by_input);
  return out;
}

}  // namespace core
