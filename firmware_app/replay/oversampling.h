#pragma once

#include <string>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/replay/analysis.h"

namespace app {

// The window of the identification is fixed in samples. At a rate far above that of the motion it is short for the
// modes.

// Frequency above which no channel moves: its power is no more than white noise, or 50 dB below the channel's
// strongest, as acceleration. Half the rate where the motion takes more than a quarter of the spectrum. 0 = nothing
// moves.
[[nodiscard]] double moves_up_to_hz(const ChannelSeries& series);

// Decimates a record at four times the rate that its motion needs, or more, so that all motion stays in the passband.
// Returns the factor; describes the change in `remarks`.
int decimate_to_motion(ChannelSeries& series, std::vector<std::string>& remarks);

// What to say about a record whose velocity is far below half the rate, though something moves above. Empty: nothing.
[[nodiscard]] std::string remark_on_oversampling(const core::CpsdSums& sums,
                                                 const std::vector<core::ChannelInfo>& channels);

}  // namespace app
