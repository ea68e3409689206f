#pragma once

#include <string>

#include "drivers/exchange/exchange_run.h"

namespace drivers {

// MCAP for Foxglove and other viewers, JSON messages with JSON schemas:
//   /displacement  one message a frame: value of every channel, null where missing; in the run's unit
//   /modes         one message: every mode with sigma and shape, and the channels' places and axes
//   /spectrum, /correlation  one message each: arrays, to be plotted over their frequency or lag
// Times are stream times (0 = first frame). Numbers are the shortest text that reads back to the same double. Throws
// FileError.
void write_mcap(const ExchangeRun& run, const std::string& path);

}  // namespace drivers
