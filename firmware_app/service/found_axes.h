#pragma once

#include "firmware_app/config/config.h"

namespace app {

// Tracks the first seconds of the source where a region's axis is not declared, and takes the axis from its motion. The
// source is opened for it and given back: a recording begins anew afterwards, a device goes on with what it sees then.
[[nodiscard]] AppConfig with_found_axes(const AppConfig& declared);

}  // namespace app
