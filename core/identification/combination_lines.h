#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// Poles at an exact combination n f_s +- k f of a stronger one's frequency f: what a tracker that is not linear, or a
// sampling that is not uniform, makes of a strong line. With less than a thousandth of its power they are harmonics,
// whatever else they look like; with more, the combination is stated in the reason, for the modes of a string are exact
// multiples, too. modes: of these sums, in any order.
void reject_combinations(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, std::vector<Mode>& modes);

}  // namespace core
