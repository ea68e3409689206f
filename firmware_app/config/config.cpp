#include "firmware_app/config/config.h"

#include <fmt/format.h>

#include <cstddef>
#include <optional>
#include <utility>

#include "drivers/storage/yaml.h"
#include "firmware_app/config/config_check.h"
#include "firmware_app/config/config_table.h"
#include "firmware_app/config/region_axis.h"

namespace app {
namespace {

using drivers::printable;
using drivers::YamlNode;
constexpr std::size_t kMaxRegions = 64;

std::string shown(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      return "nothing";
    case YamlNode::Kind::kMap:
      return "a section";
    case YamlNode::Kind::kScalar:
      break;
    case YamlNode::Kind::kList: {
      std::string text;
      for (const YamlNode& item : node.items) text += (text.empty() ? "" : ", ") + shown(item);
      return fmt::format("[{}]", printable(text));
    }
  }
  return node.quoted || node.text.empty() ? fmt::format("\"{}\"", printable(node.text)) : printable(node.text);
}

// Path of a key: as written ("regions.0.name") and as in the table ("regions[].name").
struct Place {
  std::string written;
  std::string table;
  std::size_t i_region = 0;
  [[nodiscard]] Place child(const std::string& key) const {
    return {written.empty() ? key : written + "." + key, table.empty() ? key : table + "." + key, i_region};
  }
};

class Loader {
 public:
  explicit Loader(std::string file_name) : file_name_(std::move(file_name)) {}

  [[nodiscard]] AppConfig load(const std::string& text, const std::vector<std::string>& overrides) {
    const YamlNode root = drivers::parse_yaml(text, file_name_);
    if (root.kind == YamlNode::Kind::kNull)
      throw ConfigError(file_name_ + ": is empty; see --help-config for an example");
    take_section(root, {});
    for (const std::string& override_text : overrides) take_override(override_text);
    check_config(config_, origins_, file_name_);
    config_.hash = canonical_hash(config_);
    return std::move(config_);
  }

 private:
  [[nodiscard]] std::string where(int line) const {
    return override_.empty() ? fmt::format("{}:{}", file_name_, line) : override_;
  }
  [[noreturn]] void refuse(const YamlNode& node, const Place& place, const std::string& allowed,
                           const std::string& remedy) const {
    const std::string key = place.written.empty() ? std::string("the file") : printable(place.written, 100);
    throw ConfigError(
        fmt::format("{}: {}: {} is refused: allowed {}; {}", where(node.line), key, shown(node), allowed, remedy));
  }
  [[noreturn]] void refuse_unknown(int line, const Place& place) const {
    throw ConfigError(
        fmt::format("{}: {}: unknown key; {}", where(line), printable(place.written, 100), suggest_key(place.table)));
  }

  void take_section(const YamlNode& node, const Place& place) {
    if (node.kind == YamlNode::Kind::kNull) return;  // a section whose keys are all commented out
    if (node.kind != YamlNode::Kind::kMap)
      refuse(node, place, "a section with `key: value` lines", "see --help-config for an example");
    for (std::size_t i = 0; i < node.keys.size(); ++i) {
      const Place child = place.child(node.keys[i]);
      // Dots and brackets belong to the notation of paths, not to keys of a file.
      if (node.keys[i].find_first_of(".[") != std::string::npos) refuse_unknown(node.key_lines[i], child);
      if (find_key(child.table) == nullptr && !is_section(child.table) && child.table != "regions") {
        refuse_unknown(node.key_lines[i], child);
      }
      take(node.items[i], child);
    }
  }

  void take(const YamlNode& node, const Place& place) {
    if (place.table == "regions") return take_regions(node, place);
    const ConfigKey* key = find_key(place.table);
    if (key == nullptr) return take_section(node, place);
    if (const auto remedy = key->set(config_, place.i_region, node)) {
      const std::string unit = key->unit.empty() ? "" : fmt::format(" ({})", key->unit);
      refuse(node, place, key->allowed + unit, *remedy);
    }
    origins_[place.written] = where(node.line);
  }

  void take_regions(const YamlNode& node, const Place& place) {
    if (node.kind != YamlNode::Kind::kList || node.items.empty()) {
      refuse(node, place, "a list of 1 or more regions",
             "write e.g. `- {name: roof, rect: [100, 100, 200, 80]}` under it");
    }
    if (node.items.size() > kMaxRegions) refuse_count(node.items.size());
    config_.regions.assign(node.items.size(), undeclared_region());
    std::erase_if(origins_, [](const auto& origin) { return origin.first.starts_with("regions."); });
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const Place region{fmt::format("{}.{}", place.written, i), "regions[]", i};
      if (node.items[i].kind != YamlNode::Kind::kMap)
        refuse(node.items[i], region, "a region", "write {name: ..., rect: [...]}");
      take_section(node.items[i], region);
    }
  }

  [[noreturn]] void refuse_count(std::size_t n) const {
    throw ConfigError(fmt::format("{}: regions: {} regions are refused: allowed 1 .. {}; remove some",
                                  override_.empty() ? file_name_ : override_, n, kMaxRegions));
  }

  // Applies "section.key=value" of the command line.
  void take_override(const std::string& text) {
    const std::size_t equals = text.find('=');
    override_ = "--set " + printable(text, 200);
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(override_ + ": is refused: allowed section.key=value; e.g. --set camera.rate_hz=25");
    }
    if (text.substr(0, equals).find('[') != std::string::npos)
      refuse_unknown(0, {text.substr(0, equals), text.substr(0, equals), 0});
    const Place place = place_of(text.substr(0, equals));
    const ConfigKey* key = find_key(place.table);
    if (key == nullptr && place.table != "regions" && place.table != "regions[]" && !is_section(place.table))
      refuse_unknown(0, place);
    take(override_value(text.substr(equals + 1), key), place);
    override_.clear();
  }

  // "regions.2.axis" names the third region; the number after the last one adds a region.
  [[nodiscard]] Place place_of(const std::string& path) {
    constexpr std::string_view kList = "regions.";
    if (!path.starts_with(kList)) return {path, path, 0};
    const std::size_t dot = path.find('.', kList.size());
    const auto index = drivers::parse_unsigned(std::string_view(path).substr(0, dot).substr(kList.size()));
    if (!index || *index > config_.regions.size()) {
      throw ConfigError(fmt::format("{}: {} is refused: allowed regions.0 .. regions.{}; count from 0", override_,
                                    printable(path), config_.regions.size()));
    }
    if (*index >= kMaxRegions) refuse_count(*index + 1);
    if (*index == config_.regions.size()) config_.regions.push_back(undeclared_region());
    const std::string rest = dot == std::string::npos ? "" : path.substr(dot);
    return {fmt::format("regions.{}{}", *index, rest), "regions[]" + rest, static_cast<std::size_t>(*index)};
  }

  // A text is taken literally (paths may contain any character); lists and sections are parsed as YAML.
  [[nodiscard]] YamlNode override_value(const std::string& value, const ConfigKey* key) const {
    const bool is_text = key != nullptr && key->type == "text";
    if (!is_text && (value.starts_with('[') || value.starts_with('{'))) return drivers::parse_yaml(value, override_);
    drivers::require_text(value, override_);
    YamlNode node;
    node.kind = YamlNode::Kind::kScalar;
    node.text = value;
    return node;
  }

  std::string file_name_;
  std::string override_;  // the override being applied, for messages; empty while the file is read
  AppConfig config_;
  KeyOrigins origins_;
};

}  // namespace

AppConfig parse_config(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
  try {
    return Loader(name).load(text, overrides);
  } catch (const drivers::FileError& error) {
    throw ConfigError(error.what());
  }
}

AppConfig load_config(const std::string& path, const std::vector<std::string>& overrides) {
  std::string text;
  try {
    text = drivers::read_text_file(path, drivers::YamlLimits{}.max_bytes);
  } catch (const drivers::FileError& error) {
    throw ConfigError(error.what());
  }
  return parse_config(text, path, overrides);
}

}  // namespace app
