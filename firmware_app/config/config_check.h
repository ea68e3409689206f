#pragma once

#include <map>
#include <string>

#include "firmware_app/config/config.h"

namespace app {

// Source of each written key: "camera.rate_hz" -> "FILE:LINE" or "--set camera.rate_hz=25". Regions as
// "regions.0.name".
using KeyOrigins = std::map<std::string, std::string>;

// Rules about several keys: required keys, keys that need or exclude each other, names. Throws ConfigError.
void check_config(const AppConfig& config, const KeyOrigins& origins, const std::string& file_name);

}  // namespace app
