#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "core/types/role_names.h"
#include "drivers/storage/text_file.h"
#include "firmware_app/config/config_table.h"
#include "tools/hovermodal/regions/picker.h"
#include "tools/hovermodal/regions/regions_text.h"

namespace tools {
namespace {

using nlohmann::json;

constexpr std::size_t kMostRegions = 100;
constexpr double kLeastSide_px = 3.0;

std::string text_of(const json& item, const char* key) {
  const auto found = item.find(key);
  if (found == item.end() || !found->is_string()) throw std::invalid_argument(fmt::format("a region has no {}", key));
  return found->get<std::string>();
}

// The configuration's own keys define the allowed names, roles and axes.
void take(const json& item, const char* key, app::AppConfig& config) {
  drivers::YamlNode node;
  node.kind = drivers::YamlNode::Kind::kScalar;
  node.text = text_of(item, key);
  const app::ConfigKey& rule = *app::find_key(fmt::format("regions[].{}", key));
  if (const auto remedy = rule.set(config, 0, node)) {
    throw std::invalid_argument(fmt::format("{}: {} \"{}\": {} ({})", config.regions.front().name, key,
                                            drivers::printable(node.text), *remedy, rule.allowed));
  }
}

void set_rect(const json& item, int width_px, int height_px, core::Region& region) {
  const auto rect = item.find("rect");
  const bool is_list = rect != item.end() && rect->is_array() && rect->size() == 4 &&
                       std::all_of(rect->begin(), rect->end(), [](const json& n) { return n.is_number_integer(); });
  if (!is_list) throw std::invalid_argument(fmt::format("{}: rect: four whole numbers", region.name));
  const auto number = [&](std::size_t i) {
    const auto value = (*rect)[i].get<std::int64_t>();
    return static_cast<double>(std::clamp<std::int64_t>(value, -1'000'000, 1'000'000));
  };
  region.u_px = number(0), region.v_px = number(1), region.width_px = number(2), region.height_px = number(3);
  const bool is_inside = region.u_px >= 0 && region.v_px >= 0 && region.width_px >= kLeastSide_px &&
                         region.height_px >= kLeastSide_px && region.u_px + region.width_px <= width_px &&
                         region.v_px + region.height_px <= height_px;
  if (!is_inside) {
    throw std::invalid_argument(
        fmt::format("{}: does not lie in the image of {} x {} px", region.name, width_px, height_px));
  }
}

core::Region read_region(const json& item, int width_px, int height_px) {
  if (!item.is_object()) throw std::invalid_argument("a region is no object");
  app::AppConfig config;
  config.regions.resize(1);
  core::Region& region = config.regions.front();
  region.name = "a region";
  for (const char* key : {"name", "role", "axis"}) take(item, key, config);
  set_rect(item, width_px, height_px, region);
  return region;
}

}  // namespace

std::vector<core::Region> read_regions(std::string_view text, int width_px, int height_px) {
  const json root = json::parse(text, nullptr, false);
  const bool has_list = root.is_object() && root.contains("regions") && root["regions"].is_array();
  if (!has_list) throw std::invalid_argument("expected {\"regions\": [...]}");
  const json& list = root["regions"];
  if (list.empty() || list.size() > kMostRegions)
    throw std::invalid_argument(fmt::format("{} regions: 1 to {} are possible", list.size(), kMostRegions));
  std::vector<core::Region> out;
  std::set<std::string> names;
  for (const json& item : list) {
    out.push_back(read_region(item, width_px, height_px));
    if (!names.insert(out.back().name).second)
      throw std::invalid_argument(fmt::format("two regions are called {}", out.back().name));
  }
  return out;
}

std::string regions_json(const std::vector<core::Region>& regions, int width_px, int height_px) {
  json out{{"size", {width_px, height_px}}, {"regions", json::array()}};
  for (const core::Region& r : regions) {
    const auto whole = [](double value) { return static_cast<std::int64_t>(value); };
    out["regions"].push_back({{"name", r.name},
                              {"rect", {whole(r.u_px), whole(r.v_px), whole(r.width_px), whole(r.height_px)}},
                              {"role", core::to_string(r.role)},
                              {"axis", axis_text(r)}});
  }
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace tools
