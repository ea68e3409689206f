#pragma once

#include <map>
#include <string>

#include "firmware_app/config.h"

namespace app {

// Where each written key stands: "camera.rate_hz" -> "FILE:LINE" or "--set camera.rate_hz=25". Regions as
// "regions.0.name".
using KeyOrigins = std::map<std::string, std::string>;

// What no single key can be judged by: required keys, keys that need or exclude each other, names. Throws ConfigError.
void check_config(const AppConfig& config, const KeyOrigins& origins, const std::string& file_name);

}  // namespace app
