#pragma once

#include <string>
#include <vector>

#include "firmware_app/replay/analysis.h"

namespace app {

// Preparation of a record for spectra. Each function adds a description of its changes to `remarks`.

// Excludes channels that have no sample, no motion (all values equal except for rounding), or equal another channel or
// a multiple of one; `references` are adapted. Throws std::invalid_argument when no channel is left, or none of the
// requested references.
void leave_out_unusable(ChannelSeries& series, std::vector<int>& references, std::vector<std::string>& remarks);

// Decimates so that max_frequency_hz stays in the passband (0: no decimation); returns the factor.
int decimate_to(ChannelSeries& series, double max_frequency_hz, std::vector<std::string>& remarks);

// A power of two of samples, about an eighth of the record: 512 .. 4096, from 64 on where 768 do not fit.
[[nodiscard]] int automatic_segment(std::size_t n_samples) noexcept;

}  // namespace app
