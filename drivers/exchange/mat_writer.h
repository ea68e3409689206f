#pragma once

#include <string>

#include "drivers/exchange/exchange_run.h"

namespace drivers {

// MAT version 5 through libmatio, flat variables, NaN = missing or unknown:
//   channel_names (cells), unit, rate_hz, t_s (frames), displacement (frames x channels), delay_s (channels)
//   node_names (cells), node_xy (nodes x 2), channel_node (from 1), channel_direction_xy (channels x 2)
//   frequency_hz, frequency_sigma_hz, damping, damping_sigma, mpc (modes), verdict (cells)
//   shape (channels x modes, complex), shape_sigma (channels x modes)
//   spectrum_frequency_hz (bins), spectrum (bins x pairs, complex), spectrum_pair (pairs x 2, channels from 1)
//   correlation_lag_s (lags), correlation (lags x pairs), correlation_pair (pairs x 2)
// Variables without content are left out. The header has no date: the same run gives the same bytes. Throws FileError.
void write_mat(const ExchangeRun& run, const std::string& path);

}  // namespace drivers
