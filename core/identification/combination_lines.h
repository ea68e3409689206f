#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// Rejects poles at an exact combination n f_s +- k f of the frequency f of a stronger one. A tracker that is not
// linear, or sampling that is not uniform, generates such combinations of a strong line. A pole with less than a
// thousandth of its power is a harmonic, whatever else it resembles; with more, the reason mentions the combination,
// because the modes of a string are exact multiples, too. modes: of these sums, in any order.
void reject_combinations(const CpsdSums& sums, const std::vector<ChannelInfo>& channels, std::vector<Mode>& modes);

}  // namespace core
