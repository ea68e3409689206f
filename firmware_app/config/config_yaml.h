#pragma once

#include <string>

#include "firmware_app/config/config.h"

namespace app {

// The configuration as a file from which parse_config reads the same values; keys with default values are left out.
[[nodiscard]] std::string config_yaml(const AppConfig& config);

}  // namespace app
