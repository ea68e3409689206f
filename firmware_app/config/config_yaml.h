#pragma once

#include <string>

#include "firmware_app/config/config.h"

namespace app {

// The configuration as a file that parse_config reads back to the same values; keys at their defaults are left out.
[[nodiscard]] std::string config_yaml(const AppConfig& config);

}  // namespace app
