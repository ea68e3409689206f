#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/structure/frame_fit.h"

namespace core::structure {

// How well each place of a located effect explains the reference, all other parameters fitted.
struct PlaceFit {
  std::size_t place = 0;              // from 1
  std::string meaning;                // of the fitted values there
  double chi2 = 0.0;                  // infinite: no fit
  bool is_indistinguishable = false;  // chi2 within the 95 % level of one degree of freedom of the best one
};
// `effect`: index in model.effects of an effect whose first parameter is a place; empty if it has none. `spread`:
// factor of the reference's sigmas (Birge's ratio).
[[nodiscard]] std::vector<PlaceFit> place_profile(const FrameModel& model, const std::vector<ReferenceMode>& reference,
                                                  const FrameFit& fit, std::size_t effect, double spread);

// What the reference modes determine of the parameters that have a prior.
struct Identifiability {
  std::string parameter;
  double sigma_over_prior = 0.0;  // 1: the modes determine nothing
};
[[nodiscard]] std::vector<Identifiability> identifiability(const FrameModel& model, const FrameFit& fit);

}  // namespace core::structure
