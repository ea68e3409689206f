#pragma once

#include <string>
#include <vector>

#include "firmware_app/config/config.h"

namespace app {

// Throws ConfigError where the sensor's readout is longer than a frame.
void check_against_rate(const AppConfig& config, double rate_hz);

// Values that are possible but implausible, with the likely mistake: readout or exposure in another unit, a length in
// metres. mm_per_px: 0 = unknown; camera_rate_hz: of the frames; stated_hz: as stated by the container, 0 = not stated.
[[nodiscard]] std::vector<std::string> doubtful_values(const AppConfig& config, double camera_rate_hz, double stated_hz,
                                                       double mm_per_px);

}  // namespace app
