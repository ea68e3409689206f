#pragma once

#include "firmware_app/config/config.h"

namespace app {

// Tracks the first seconds of the source where a region's axis is not declared, and takes the axis from its motion. The
// source is opened for it and given back: a recording then starts again, a device continues with its current frames.
[[nodiscard]] AppConfig with_found_axes(const AppConfig& declared);

}  // namespace app
