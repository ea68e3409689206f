#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware_app/replay/analysis.h"

namespace app {

// Detects what loggers write where they measured nothing, in channels on a grid. Each fault is masked (NaN), named with
// its channel, number and first time in `remarks`, and counted:
//   fill values   a value (-9999, 9.91E+37, 1e6 ...) far outside the range of all others
//   stuck         a value repeated far longer than this channel ever repeats one, while others move
// outliers      single samples that are inconsistent with their neighbours in time (core/spectrum/outlier_gate.h)
// Saturation, a largest or smallest value that occurs far too often, is reported, not masked: the clipped part is
// unknown. Returns the number of outliers per channel.
std::vector<std::uint64_t> mask_faults(ChannelSeries& series, std::vector<std::string>& remarks);

}  // namespace app
