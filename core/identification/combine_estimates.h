#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/identification/inverse_variance.h"
#include "core/types/modal_estimate.h"

namespace core {

// One of several estimates of the structure's modes; borrowed.
struct EstimateInput {
  std::vector<std::string> channels;  // names of the shapes' channels
  const ModalEstimate* estimate = nullptr;
  bool is_combined = true;  // false: it is matched only, because its data are already contained in another one
};

struct ModePlace {
  std::size_t i_estimate = 0, i_mode = 0;  // of EstimateInput::estimate->modes
};

// Combined result of several estimates for one mode.
struct ModeGroup {
  std::vector<ModePlace> members;            // ordered by estimate, at most one of each
  WeightedMean frequency_hz, damping_ratio;  // of the combined members; n = 0: there are none
};

// Structural modes of different estimates are the same where |df| / (0.03 f) + (1 - MAC) / 0.5 < 1, by average linkage,
// at most one per estimate; the MAC uses the channels that both have by name and is ignored with fewer than two.
// Frequencies are combined by inverse variance; damping in its logarithm, because its standard deviation grows with its
// value and a low estimate would weigh too much. A mode without standard deviation is excluded, unless none has one:
// then the mean is weighted by duration and has no standard deviation. Groups are ordered by frequency.
[[nodiscard]] std::vector<ModeGroup> combine_estimates(const std::vector<EstimateInput>& estimates);

// Mean over a subset of a group's members, e.g. over those that were not combined.
[[nodiscard]] WeightedMean mean_frequency(const std::vector<EstimateInput>& estimates,
                                          const std::vector<ModePlace>& members);
[[nodiscard]] WeightedMean mean_damping(const std::vector<EstimateInput>& estimates,
                                        const std::vector<ModePlace>& members);

}  // namespace core
