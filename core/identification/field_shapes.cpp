#include "core/identification/field_shapes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/identification/block_covariance.h"
#include "core/identification/given_inputs.h"
#include "core/identification/hankel_changes.h"
#include "core/identification/hankel_weights.h"
#include "core/identification/mode_sigmas.h"
#include "core/linear/dense.h"

namespace core {

namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;

std::vector<int> first_channels(std::size_t n) {
  std::vector<int> out(n);
  std::iota(out.begin(), out.end(), 0);
  return out;
}

// Real and imaginary parts of right_map psi of every pole, side by side.
MatrixXd directions_of(const Realisation& realisation, const std::vector<PoleVector>& vectors) {
  MatrixXd out = MatrixXd::Zero(realisation.right_map.rows(), 2 * static_cast<Index>(vectors.size()));
  for (std::size_t p = 0; p < vectors.size(); ++p) {
    const Eigen::VectorXcd direction = realisation.right_map.leftCols(vectors[p].psi.size()) * vectors[p].psi;
    out.col(2 * static_cast<Index>(p)) = direction.real();
    out.col(2 * static_cast<Index>(p) + 1) = direction.imag();
  }
  return out;
}

}  // namespace

// Of further channels, in their own units; references have unit variance.
struct FieldShapes::Rows {
  MatrixXd c;                        // channel x state
  MatrixXd by_input;                 // channel x (sample, input)
  std::vector<MatrixXd> deviations;  // per part: channel x (lag, reference)
};

FieldShapes::FieldShapes(const CpsdSums& sums, ModelFit fit, FoldingConfig folding, std::vector<FieldLine> lines)
    : fit_(std::move(fit)), folding_(std::move(folding)), lines_(std::move(lines)) {
  const Realisation& realisation = fit_.realisation;
  references_ = outer_references_ = hankel_change_references(fit_.era);
  std::vector<PoleOfOrder> poles;
  for (const FieldLine& line : lines_) {
    poles.push_back(line.observed);
    vectors_.push_back(pole_vector(realisation, line.observed));
  }
  RowDirections row = row_directions(realisation, fit_.era, realisation.right_map);
  first_lag_ = row.first_lag, n_lags_ = row.n_lags;
  to_states_ = std::move(row.value);
  changes_.resize(lines_.size()), input_changes_.resize(lines_.size());
  n_groups_ = std::min(kScatterBlocks, sums.n_blocks);
  if (n_groups_ < kLeastScatterBlocks) n_groups_ = 0;
  if (n_groups_ == 0) return;
  overlap_ = overlap_factor(sums, static_cast<double>(n_groups_));
  const BlockDeviations deviations =
      block_deviations(sums, references_, hankel_change_lags(fit_.era, fit_.n_differences), n_groups_);
  changes_ = pole_changes(realisation, fit_.era, deviations, poles);
  const MatrixXd inputs =
      hankel_changes(realisation, fit_.era, deviations, directions_of(realisation, vectors_)).inputs;
  const auto n_lines = static_cast<Index>(lines_.size());
  for (Index p = 0; p < n_lines; ++p) {
    Eigen::MatrixXcd& own = input_changes_[static_cast<std::size_t>(p)];
    own.resize(inputs.rows(), static_cast<Index>(n_groups_));
    for (Index block = 0; block < own.cols(); ++block) {
      own.col(block).real() = inputs.col(2 * (block * n_lines + p));
      own.col(block).imag() = inputs.col(2 * (block * n_lines + p) + 1);
    }
  }
}

void FieldShapes::renumber(const std::vector<std::size_t>& channels) {
  for (int& reference : outer_references_) {
    reference = static_cast<int>(channels[static_cast<std::size_t>(reference)]);
  }
}

std::vector<FieldShapes::Components> FieldShapes::of(const CpsdSums& sums, const std::vector<ChannelInfo>& further,
                                                     const std::vector<double>& delay_s) const {
  const auto n_references = static_cast<Index>(references_.size()), n = static_cast<Index>(further.size());
  const std::vector<int> own = first_channels(references_.size());
  std::vector<Components> out(lines_.size());
  Correlations correlations;
  if (lines_.empty()) return out;
  if (compute_correlations(sums, furthest_lag(fit_.era), fit_.n_differences, correlations, own, 0.0) !=
      CorrelationStatus::kOk) {
    return out;
  }
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(n_references + n);
  for (Index r = 0; r < n_references; ++r) scale[r] = fit_.realisation.scale[references_[static_cast<std::size_t>(r)]];

  std::vector<int> channels(further.size());
  std::iota(channels.begin(), channels.end(), static_cast<int>(n_references));
  const SampleWindow now{channels, 0, 1, 1}, before{own, -first_lag_, n_lags_, -1};
  Rows rows;
  rows.c = MatrixXd::Zero(n, to_states_.cols());
  add_product(rows.c, 1.0, block_covariance(correlations, scale, now, before, Estimate::kDivided), to_states_);
  if (!fit_.era.inputs.empty()) {
    SampleWindow input = given_inputs(fit_.era, static_cast<int>(fit_.realisation.scale.size())).input;
    const auto n_inputs = static_cast<Index>(input.channels.size());
    input.channels = std::vector<int>(own.end() - n_inputs, own.end());
    MatrixXd stacked;
    if (!factor_with_ridge(block_covariance(correlations, scale, input, input, Estimate::kDivided),
                           block_covariance(correlations, scale, now, input, Estimate::kDivided), stacked)) {
      return out;
    }
    rows.by_input = stacked.bottomRows(n);
    divide_by_lower(rows.by_input, stacked.topRows(input.size()));
  }
  if (n_groups_ > 0) {
    const BlockDeviations deviations =
        block_deviations(sums, own, {first_lag_, n_lags_, fit_.n_differences}, n_groups_);
    for (Index block = 0; block < deviations.n_blocks; ++block) {
      rows.deviations.emplace_back(deviations.value.middleRows(block * (n_references + n) + n_references, n));
      for (Index c = 0; c < rows.deviations.back().cols(); ++c)
        rows.deviations.back().col(c) /= scale[c % n_references];
    }
  }
  FoldingConfig folding = folding_;
  folding.delay_s.resize(static_cast<std::size_t>(fit_.realisation.scale.size()), 0.0);
  folding.n_integrations.resize(folding.delay_s.size(), 0);
  for (std::size_t i = 0; i < further.size(); ++i) {
    folding.delay_s.push_back(delay_s[i]);
    folding.n_integrations.push_back(further[i].n_integrations);
  }
  for (std::size_t line = 0; line < lines_.size(); ++line) out[line] = of_line(line, rows, folding);
  return out;
}

FieldShapes::Components FieldShapes::of_line(std::size_t line, const Rows& rows, const FoldingConfig& folding) const {
  const FieldLine& own = lines_[line];
  const Eigen::VectorXcd& psi = vectors_[line].psi;
  const Complex factor = vectors_[line].factor;
  const Index n = psi.size();
  Components out;
  if (own.is_mixed || n == 0) return out;
  out.is_known = true;
  PoleOfOrder pole = own.observed;
  const std::size_t n_own = pole.pole.shape.size();
  const auto append = [&](std::vector<Complex>& shape, const Eigen::VectorXcd& more) {
    for (const Complex& component : more) shape.push_back(factor * component);
  };
  append(pole.pole.shape, rows.c.leftCols(n) * psi);
  const auto tail = [&](const auto& all) {
    using Values = std::decay_t<decltype(all)>;
    return Values(all.begin() + static_cast<std::ptrdiff_t>(n_own), all.end());
  };
  out.shape = tail(stated_components(pole, own.unfolded, folding, own.along, n_own));
  std::vector<PoleChange> changes = own.has_std ? changes_[line] : std::vector<PoleChange>{};
  const Eigen::VectorXcd direction = to_states_.leftCols(n) * psi;
  for (std::size_t block = 0; block < changes.size(); ++block) {
    Eigen::VectorXcd moved = rows.deviations[block] * direction + rows.c.leftCols(n) * changes[block].psi;
    if (rows.by_input.cols() > 0) moved -= rows.by_input * input_changes_[line].col(static_cast<Index>(block));
    append(changes[block].shape, moved);
  }
  const auto scatter = mode_scatter(pole, own.unfolded, folding, changes, n_own);
  if (scatter) out.std = tail(own.along ? scatter->along : scatter->shape);
  for (double& sigma : out.std) sigma *= std::sqrt(overlap_);
  return out;
}

}  // namespace core
