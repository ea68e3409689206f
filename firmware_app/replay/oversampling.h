#pragma once

#include <string>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// The window of the identification is fixed in samples. At a rate far above that of the motion it is short for the
// modes.

// Decimates a record at four times the rate that its motion needs, or more, so that all motion stays in the passband:
// what lies above white noise, and within 50 dB of its channel's strongest acceleration.
// Returns the factor; describes the change in `remarks`.
int decimate_to_motion(ChannelSeries& series, std::vector<std::string>& remarks);

// What to say about a record whose velocity is far below half the rate, though something moves above. Empty: nothing.
[[nodiscard]] std::string remark_on_oversampling(const core::CpsdSums& sums,
                                                 const std::vector<core::ChannelInfo>& channels);

}  // namespace app
