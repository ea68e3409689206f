#pragma once

#include <string>
#include <vector>

#include "core/tracking/region_proposal.h"

namespace tools {

// By name, part1 first, the static one last: the order of the file and of the picture.
[[nodiscard]] std::vector<core::Region> in_order(const core::RegionProposal& proposal);

// Gives the lowest part the role `base` and the name "base" and returns nothing; or changes nothing and returns why
// that would be a guess: the parts are not one above the other, something below it moves, another part moves less.
[[nodiscard]] std::string make_lowest_base(core::RegionProposal& proposal);

// One line per region, in the order of the proposal.
// The table and the remark as JSON.
[[nodiscard]] std::string proposal_json(const core::RegionProposal& proposal, int width_px, int height_px);
[[nodiscard]] std::string regions_table(const core::RegionProposal& proposal);

// The regions: block of a configuration.
[[nodiscard]] std::string regions_yaml(const std::vector<core::Region>& regions);

// In the configuration's notation.
[[nodiscard]] std::string axis_text(const core::Region& region);

}  // namespace tools
