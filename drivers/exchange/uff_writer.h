#pragma once

#include <string>

#include "drivers/exchange/exchange_run.h"

namespace drivers {

// Universal file: 151 (header, without a date, so that the same run gives the same bytes), 164 (units), 15 (nodes, one
// a region), 82 (a line through them), 55 (one a mode: eigenvalue of first order, complex shape), 58 (displacements,
// spectral densities, correlations). Shapes and places have the format's 6 digits, functions 13. Missing samples are
// left out: such a channel is written with its times. Throws FileError.
void write_uff(const ExchangeRun& run, const std::string& path);

}  // namespace drivers
