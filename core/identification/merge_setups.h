#pragma once

#include <string>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// One of several records of a structure; all sensors except the references were moved between the records.
struct SetupModes {
  std::string name;
  ModalEstimate estimate;
  std::vector<ChannelInfo> channels;    // of the estimate's shapes
  std::vector<std::string> references;  // names of channels, in the same order in every set-up
};

struct MergedSetups {
  ModalEstimate estimate;             // durations and segments are summed
  std::vector<ChannelInfo> channels;  // references as in the first set-up, then "<set-up>.<channel>"
  std::vector<std::string> remarks;
};

// Joins set-ups that were identified separately (PoSER: Reynders, Magalhaes, De Roeck & Cunha 2009). Structural modes
// of different set-ups are the same where |df| / (0.03 f) + (1 - MAC over the references) / 0.5 < 1, nearest pairs
// first, at most one per set-up. Frequency and damping are means weighted by duration: standard deviations of single
// records are too uncertain. Shapes are scaled to the first set-up's reference part by least squares and joined; rows
// of references are averaged, weighted by duration. Modes missing in a set-up are rejected, with the reason.
//
// Rates may differ. Throws std::invalid_argument: fewer than two set-ups, no reference, or a reference that is missing
// in a set-up.
[[nodiscard]] MergedSetups merge_setups(const std::vector<SetupModes>& setups);

}  // namespace core
