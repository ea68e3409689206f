#include "firmware_app/config_yaml.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "firmware_app/config_table.h"

namespace app {
namespace {

// A JSON string is a YAML string in double quotes.
std::string value_text(const ConfigKey& key, AppConfig& config, std::size_t i_region) {
  std::string text = key.canonical(config, i_region);
  return key.type == "text" ? nlohmann::json(text == "\"\"" ? "" : text).dump() : text;
}

std::string regions_yaml(AppConfig& config) {
  AppConfig plain;
  plain.regions.resize(1);
  std::string out = config.regions.empty() ? "" : "regions:\n";
  for (std::size_t i = 0; i < config.regions.size(); ++i) {
    std::string members;
    for (const ConfigKey& key : config_keys()) {
      constexpr std::string_view kPrefix = "regions[].";
      if (!key.path.starts_with(kPrefix) || key.canonical(config, i) == key.canonical(plain, 0)) continue;
      members += fmt::format("{}{}: {}", members.empty() ? "" : ", ", key.path.substr(kPrefix.size()),
                             value_text(key, config, i));
    }
    out += fmt::format("  - {{{}}}\n", members);
  }
  return out;
}

}  // namespace

std::string config_yaml(const AppConfig& config) {
  AppConfig copy = config, plain;
  std::string out, section;
  for (const ConfigKey& key : config_keys()) {
    if (key.path.starts_with("regions[]") || key.canonical(copy, 0) == key.canonical(plain, 0)) continue;
    const std::size_t dot = key.path.find('.');
    if (dot == std::string::npos) {
      out += fmt::format("{}: {}\n", key.path, value_text(key, copy, 0));
      continue;
    }
    if (key.path.substr(0, dot) != section) out += fmt::format("{}:\n", section = key.path.substr(0, dot));
    out += fmt::format("  {}: {}\n", key.path.substr(dot + 1), value_text(key, copy, 0));
  }
  return out + regions_yaml(copy);
}

}  // namespace app
