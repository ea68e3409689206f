#include "firmware_app/config/config_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "firmware_app/config/config_table.h"
#include "firmware_app/config/region_axis.h"

namespace app {
namespace {

// A JSON string is also a YAML string in double quotes.
std::string value_text(const ConfigKey& key, AppConfig& config, std::size_t i_region) {
  std::string text = key.canonical(config, i_region);
  return key.type == "text" ? nlohmann::json(text == "\"\"" ? "" : text).dump() : text;
}

// Nested sections, in the order of their first keys.
struct Section {
  std::string name, value;  // value: of a key only
  std::vector<Section> members = {};

  void put(std::string_view path, std::string text) {
    const std::string_view first = path.substr(0, path.find('.'));
    auto at = std::find_if(members.begin(), members.end(), [&](const Section& member) { return member.name == first; });
    if (at == members.end()) at = members.insert(members.end(), {std::string(first), {}});
    if (first.size() == path.size()) {
      at->value = std::move(text);
    } else {
      at->put(path.substr(first.size() + 1), std::move(text));
    }
  }
  void write(std::string& out, std::size_t depth) const {
    for (const Section& member : members) {
      out +=
          std::string(2 * depth, ' ') + member.name + ":" + (member.members.empty() ? " " + member.value : "") + "\n";
      member.write(out, depth + 1);
    }
  }
};

std::string regions_yaml(AppConfig& config) {
  AppConfig plain;
  plain.regions = {undeclared_region()};
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
  Section all;
  for (const ConfigKey& key : config_keys()) {
    if (key.path.starts_with("regions[]") || key.canonical(copy, 0) == key.canonical(plain, 0)) continue;
    all.put(key.path, value_text(key, copy, 0));
  }
  std::string out;
  all.write(out, 0);
  return out + regions_yaml(copy);
}

}  // namespace app
