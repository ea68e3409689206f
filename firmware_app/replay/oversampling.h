#pragma once

#include <string>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace app {

// Frequency below which every channel moves: 99 % of the power of its velocity, without white
// noise. 0 = nothing moves.
[[nodiscard]] double moves_up_to_hz(const core::CpsdSums& sums, const std::vector<core::ChannelInfo>& channels);

// What to say about a record at a rate far above that of its motion: the window of the identification, fixed in
// samples, is then short for its modes. Empty: four times as many samples as needed, or fewer.
[[nodiscard]] std::string remark_on_oversampling(const core::CpsdSums& sums,
                                                 const std::vector<core::ChannelInfo>& channels);

}  // namespace app
