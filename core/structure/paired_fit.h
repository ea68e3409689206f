#pragma once

#include <vector>

#include "core/structure/frame_fit.h"
#include "core/structure/mode_numbers.h"

namespace core::structure {

// A fit to measured modes whose numbers in the model are not settled: an effect may move modes further than their
// distances, so that those nearest to the model without it are others. Kinds other than the plain shear frame.
struct PairedFit {
  std::vector<int> number;  // of each measured mode in this model, from 1; 0: none of the model's modes
  FrameFit fit;             // to those that have one
  double cost = 0.0;        // chi-square, a mode without a number counted as predicted 20 % wrong
};

// How the modes of a fitted model pair with all measured ones. No number at all if the model has no modes.
[[nodiscard]] Pairing pairing_of(const FrameModel& model, const FrameFit& fit,
                                 const std::vector<ReferenceMode>& measured);

// Whether a pairing leaves room for another one: a mode without a partner, or one nearly as far from it as allowed.
[[nodiscard]] bool is_ambiguous(const Pairing& pairing);

// Tries `number` and the pairings with the model at several sizes of its last effect, at all its places; each is fitted
// and paired again until numbers stay. The one of least cost. `before`: parameters of the model without the last
// effect. not fit.ok: none.
[[nodiscard]] PairedFit fit_paired(const FrameModel& model, const std::vector<ReferenceMode>& measured,
                                   const std::vector<int>& number, const Eigen::VectorXd& before);

}  // namespace core::structure
