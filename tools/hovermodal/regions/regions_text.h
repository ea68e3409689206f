#pragma once

#include <string>
#include <vector>

#include "core/tracking/region_proposal.h"

namespace tools {

// By name, part1 first, the resting one last: the order of the file and of the picture.
[[nodiscard]] std::vector<core::Region> in_order(const core::RegionProposal& proposal);

// Gives the lowest part the role `base` and the name "base". Throws std::invalid_argument unless the parts stand one
// above the other.
void make_lowest_base(core::RegionProposal& proposal);

// One line a region, the least noise first.
[[nodiscard]] std::string regions_table(const core::RegionProposal& proposal);

// The regions: block of a configuration.
[[nodiscard]] std::string regions_yaml(const std::vector<core::Region>& regions);

// As a configuration writes it.
[[nodiscard]] std::string axis_text(const core::Region& region);

}  // namespace tools
