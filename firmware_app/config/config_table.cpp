#include "firmware_app/config/config_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/types/fnv1a.h"
#include "drivers/storage/key_suggestion.h"
#include "firmware_app/config/config_sections.h"

namespace app {
namespace {

std::vector<ConfigKey> build_keys() {
  std::vector<ConfigKey> keys;
  keys.push_back(choice_key<Method>(
      "method", [](AppConfig& config, std::size_t) -> Method& { return config.method; },
      {{"paper", Method::kPaper}, {"hovermodal", Method::kHovermodal}}, "the published chain, or the improved one"));
  keys.push_back(choice_key<core::ShutterVelocity>(
      "paper.velocity", [](AppConfig& config, std::size_t) -> core::ShutterVelocity& { return config.paper.velocity; },
      {{"camera", core::ShutterVelocity::kCamera}, {"region", core::ShutterVelocity::kRegion}},
      "method paper: whose velocity the rolling shutter is undone by (V_rel of Eq. 8): the camera's against the "
      "structure, one for the image, or each region's own"));
  add_camera_keys(keys);
  add_calibration_keys(keys);
  add_region_keys(keys);
  add_scale_keys(keys);
  add_tracking_keys(keys);
  add_analysis_keys(keys);
  add_closure_keys(keys);
  add_telemetry_keys(keys);
  add_report_keys(keys);
  add_storage_keys(keys);
  add_real_time_keys(keys);
  return keys;
}

bool changes_results(const ConfigKey& key) {
  return !key.path.starts_with("telemetry.") && !key.path.starts_with("report.") && !key.path.starts_with("record.") &&
         !key.path.starts_with("state.") && !key.path.starts_with("rt.") && key.path != "camera.decoder_mb";
}

}  // namespace

const std::vector<ConfigKey>& config_keys() {
  static const std::vector<ConfigKey> keys = build_keys();
  return keys;
}

const ConfigKey* find_key(const std::string& path) {
  for (const ConfigKey& key : config_keys()) {
    if (key.path == path) return &key;
  }
  return nullptr;
}

bool is_section(const std::string& path) {
  return std::any_of(config_keys().begin(), config_keys().end(),
                     [&](const ConfigKey& key) { return key.path.starts_with(path + "."); });
}

std::string suggest_key(const std::string& path) {
  std::vector<std::string> keys;
  for (const ConfigKey& key : config_keys()) keys.push_back(key.path);
  return drivers::suggest_key(path, keys, "--help-config");
}

std::string canonical_text(const AppConfig& config) {
  AppConfig copy = config;
  std::string text;
  for (const ConfigKey& key : config_keys()) {
    if (!changes_results(key)) continue;
    const bool per_region = key.path.starts_with("regions[]");
    for (std::size_t i = 0; i < (per_region ? copy.regions.size() : 1); ++i) {
      text += fmt::format("{}{} = {}\n", key.path, per_region ? fmt::format("#{}", i) : "", key.canonical(copy, i));
    }
  }
  return text;
}

std::uint64_t canonical_hash(const AppConfig& config) { return core::fnv1a(canonical_text(config)); }

}  // namespace app
