#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "core/identification/folding.h"
#include "core/identification/mode_scatter.h"
#include "core/identification/model_fit.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// A listed pole of an estimate, as the identification found it.
struct FieldLine {
  PoleOfOrder observed;
  UnfoldedPole unfolded;
  bool along = false;     // stated along its line
  bool has_std = false;   // with a standard deviation
  bool is_mixed = false;  // a neighbour's part was taken out of its shape
};

// Components of modes in channels that did not take part in the identification. A channel's row of the realisation's C
// is one more row of the first block row of its Hankel matrix times right_map: linear in the channel's correlations
// with the references and inputs, so that time and memory grow with the number of channels, not with their pairs.
// Poles, order and weights are those of the channels identified. Thread contract: const functions may run at once.
class FieldShapes {
 public:
  FieldShapes() = default;
  // sums: those identified.
  FieldShapes(const CpsdSums& sums, ModelFit fit, FoldingConfig folding, std::vector<FieldLine> lines);

  // Channels of `sums` with which a further channel must be correlated.
  [[nodiscard]] const std::vector<int>& references() const noexcept { return outer_references_; }
  // channels[c]: the number by which references() calls channel c of the sums identified.
  void renumber(const std::vector<std::size_t>& channels);

  struct Components {
    std::vector<std::complex<double>> shape;  // relative to the estimate's: its largest component is 1
    std::vector<double> std;                  // empty = unknown
    bool is_known = false;  // false: a neighbour's part cannot be taken out, or the pole was not found again
  };
  // For every line, of channels `further`. sums: of references(), in that order, then of these channels, over the same
  // samples and with the same segments as before. delay_s: row delay of each of them that is undone.
  [[nodiscard]] std::vector<Components> of(const CpsdSums& sums, const std::vector<ChannelInfo>& further,
                                           const std::vector<double>& delay_s) const;

 private:
  struct Rows;
  [[nodiscard]] Components of_line(std::size_t line, const Rows& rows, const FoldingConfig& folding) const;

  ModelFit fit_;
  FoldingConfig folding_;
  std::vector<FieldLine> lines_;
  std::vector<int> references_, outer_references_;  // in the sums identified, and as renumbered
  std::size_t n_groups_ = 0;
  double overlap_ = 1.0;
  int first_lag_ = 0, n_lags_ = 0;
  Eigen::MatrixXd to_states_;  // (lag, reference) x state: a row of correlations times this is a row of C
  std::vector<PoleVector> vectors_;
  std::vector<std::vector<PoleChange>> changes_;  // per line and part of the record
  std::vector<Eigen::MatrixXcd> input_changes_;   // per line: (sample, input) x part of the record
};

}  // namespace core
