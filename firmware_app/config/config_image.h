#pragma once

#include "firmware_app/config/config.h"

namespace app {

// Checks that need the camera's image size: every region and both ends of the known length are inside. Throws
// ConfigError naming the region and the sizes.
void check_against_image(const AppConfig& config, int width_px, int height_px);

}  // namespace app
