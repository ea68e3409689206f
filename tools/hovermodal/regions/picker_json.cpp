#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "core/types/role_names.h"
#include "drivers/storage/text_file.h"
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

// As regions[].name in a configuration.
void check_name(const std::string& name) {
  const bool is_plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
           c == '.';
  });
  if (name.empty() || name.size() > 32 || !is_plain) {
    throw std::invalid_argument(
        fmt::format("name \"{}\": 1 to 32 letters, digits, or _ - .", drivers::printable(name)));
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

void set_axis(const std::string& axis, core::Region& region) {
  const auto degrees = drivers::parse_number(axis);
  region.both_axes = axis == "both";
  if (axis == "v") {
    region.axis_deg = 90.0;
  } else if (degrees && *degrees >= -180.0 && *degrees <= 180.0) {
    region.axis_deg = *degrees;
  } else if (axis != "u" && axis != "both") {
    throw std::invalid_argument(
        fmt::format("{}: axis \"{}\": u, v, both, or degrees from -180 to 180", region.name, drivers::printable(axis)));
  }
}

core::Region read_region(const json& item, int width_px, int height_px) {
  if (!item.is_object()) throw std::invalid_argument("a region is no object");
  core::Region region;
  region.name = text_of(item, "name");
  check_name(region.name);
  const std::string role = text_of(item, "role");
  const auto found = std::find_if(core::kRoleNames.begin(), core::kRoleNames.end(),
                                  [&](const auto& named) { return role == named.second; });
  if (found == core::kRoleNames.end())
    throw std::invalid_argument(fmt::format("{}: role \"{}\" is none", region.name, drivers::printable(role)));
  region.role = found->first;
  set_rect(item, width_px, height_px, region);
  set_axis(text_of(item, "axis"), region);
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
