#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware_app/replay/analysis.h"

namespace app {

// What loggers write where they measured nothing, of channels on a grid. Each fault is masked (NaN), named with its
// channel, number and first time in `remarks`, and counted:
//   fill values   a value (-9999, 9.91E+37, 1e6 ...) far outside the range of all others
//   stuck         a value repeated far longer than this channel ever repeats one, while others move
//   outliers      single samples that their neighbours in time do not allow (core/spectrum/outlier_gate.h)
// Saturation, a largest or smallest value that is met far too often, is named, not masked: what was cut off is unknown.
// Returns the number of outliers per channel.
std::vector<std::uint64_t> mask_faults(ChannelSeries& series, std::vector<std::string>& remarks);

}  // namespace app
