#pragma once

#include "firmware_app/config.h"

namespace app {

// What can be checked only when the camera has told its image size: every region and both ends of the known length lie
// inside. Throws ConfigError naming the region and the sizes.
void check_against_image(const AppConfig& config, int width_px, int height_px);

}  // namespace app
