#pragma once

#include <string>
#include <utility>
#include <vector>

#include "firmware_app/config/config_key.h"

namespace app {

inline constexpr double kMaxImagePx = 100000.0;

// The key, its default described in words.
[[nodiscard]] inline ConfigKey with_default(ConfigKey key, std::string text) {
  key.default_text = std::move(text);
  return key;
}

// The keys of the table, section by section (firmware_app/config/config_table.h joins them).
void add_camera_keys(std::vector<ConfigKey>& keys);
void add_calibration_keys(std::vector<ConfigKey>& keys);
void add_region_keys(std::vector<ConfigKey>& keys);
void add_region_length_key(std::vector<ConfigKey>& keys);
void add_scale_keys(std::vector<ConfigKey>& keys);
void add_tracking_keys(std::vector<ConfigKey>& keys);
void add_analysis_keys(std::vector<ConfigKey>& keys);
void add_closure_keys(std::vector<ConfigKey>& keys);
void add_telemetry_keys(std::vector<ConfigKey>& keys);
void add_report_keys(std::vector<ConfigKey>& keys);
void add_storage_keys(std::vector<ConfigKey>& keys);
void add_real_time_keys(std::vector<ConfigKey>& keys);

}  // namespace app
