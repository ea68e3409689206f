#pragma once

#include <string>
#include <vector>

#include "drivers/exchange/exchange_run.h"
#include "firmware_app/replay/analysis.h"

namespace tools {

// Spectral densities and correlations of the series, Welch with the Hann window, segments that overlap by half. All
// pairs of up to 16 channels; of more, each channel's own and those with the strongest one. Divided by the power of the
// window where both channels are seen. A segment of 0 is chosen from the record's length.
void add_spectra(const app::ChannelSeries& series, int segment, drivers::ExchangeRun& run,
                 std::vector<std::string>& remarks);

}  // namespace tools
