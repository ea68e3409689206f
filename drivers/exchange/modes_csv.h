#pragma once

#include <string>

#include "drivers/exchange/exchange_run.h"

namespace drivers {

// A flat table, one line a mode under one line of names: frequency, damping (ratio to critical), their standard
// deviations, MPC, verdict, and of every channel the shape's real and imaginary part with its standard deviation. An
// empty field is unknown. Numbers are the shortest text that reads back to the same double. Throws FileError.
void write_modes_csv(const ExchangeRun& run, const std::string& path);

}  // namespace drivers
