#pragma once

#include <string>
#include <vector>

#include "firmware_app/config/config.h"

namespace app {

// Throws ConfigError where the sensor's readout cannot fit into a frame.
void check_against_rate(const AppConfig& config, double rate_hz);

// What is possible but seldom true, with the likely slip: readout and exposure in another unit, a length in metres.
// mm_per_px: 0 = no length is known; camera_rate_hz: of the frames; stated_hz: as the container says, 0 = it does not.
[[nodiscard]] std::vector<std::string> doubtful_values(const AppConfig& config, double camera_rate_hz, double stated_hz,
                                                       double mm_per_px);

}  // namespace app
