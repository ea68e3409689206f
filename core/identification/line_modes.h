#pragma once

#include <vector>

#include "core/identification/folding.h"
#include "core/identification/steady_lines.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

// Steady lines as poles without damping and with a verdict: camera motion, input peak or harmonic. sums: with the lines
// in them; outputs: the channels of a shape, in the order of the sums' first ones.
[[nodiscard]] std::vector<Mode> judge_steady_lines(const std::vector<SteadyLine>& lines, const CpsdSums& sums,
                                                   const std::vector<ChannelInfo>& channels,
                                                   const std::vector<ChannelInfo>& outputs,
                                                   const FoldingConfig& folding);

}  // namespace core
