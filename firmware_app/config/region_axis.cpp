#include "firmware_app/config/region_axis.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "drivers/storage/yaml.h"

namespace app {
namespace {

constexpr std::string_view kAuto = "auto", kStill = "still";

bool put_direction(std::string_view text, core::Region& region) {
  const auto angle = text == "u" || text == "both" ? 0.0
                     : text == "v"                 ? 90.0
                                                   : drivers::parse_number(std::string(text));
  if (!angle || *angle < -360.0 || *angle > 360.0) return false;
  region.axis_deg = *angle;
  region.both_axes = text == "both";
  return true;
}

std::string direction_text(const core::Region& region) {
  return region.both_axes ? std::string("both") : fmt::format("{}", region.axis_deg);
}

std::vector<std::string> names_where(const AppConfig& config, core::AxisFrom from) {
  std::vector<std::string> out;
  for (const core::Region& region : config.regions)
    if (core::makes_channel(region.role) && region.axis_from == from) out.push_back(region.name);
  return out;
}

}  // namespace

bool put_axis(std::string_view text, core::Region& region) {
  core::Region next = region;
  next.axis_from = core::AxisFrom::kDeclared;
  next.axis_deg = 0.0, next.both_axes = false;
  if (!text.starts_with(kAuto)) {
    if (!put_direction(text, next)) return false;
  } else if (text == kAuto) {
    next.axis_from = core::AxisFrom::kSought;
  } else {
    const std::string_view found = text.substr(kAuto.size());
    if (!found.starts_with(' ')) return false;
    const bool is_still = found.substr(1) == kStill;
    next.axis_from = is_still ? core::AxisFrom::kNoMotion : core::AxisFrom::kMotion;
    if (!is_still && !put_direction(found.substr(1), next)) return false;
  }
  region = next;
  return true;
}

std::string axis_key_text(const core::Region& region) {
  switch (region.axis_from) {
    case core::AxisFrom::kDeclared:
      break;
    case core::AxisFrom::kSought:
      return std::string(kAuto);
    case core::AxisFrom::kMotion:
      return fmt::format("{} {}", kAuto, direction_text(region));
    case core::AxisFrom::kNoMotion:
      return fmt::format("{} {}", kAuto, kStill);
  }
  return direction_text(region);
}

std::string axis_words(const core::Region& region) {
  if (region.both_axes) return "both";
  if (region.axis_deg == 0.0) return "u";
  return region.axis_deg == 90.0 ? "v" : fmt::format("{} degrees", region.axis_deg);
}

std::string axis_origin(const core::Region& region) {
  if (region.axis_from == core::AxisFrom::kDeclared) return "declared";
  return region.axis_from == core::AxisFrom::kMotion ? "motion" : "assumed";
}

core::Region region_with_axis(std::string name, std::string_view words, std::string_view origin) {
  core::Region region;
  (void)put_axis(words.substr(0, words.find(' ')), region);
  region.name = std::move(name);
  if (origin == "motion") region.axis_from = core::AxisFrom::kMotion;
  if (origin == "assumed") region.axis_from = core::AxisFrom::kNoMotion;
  return region;
}

core::Region undeclared_region() {
  core::Region region;
  region.axis_from = core::AxisFrom::kSought;
  return region;
}

bool seeks_axes(const AppConfig& config) { return !names_where(config, core::AxisFrom::kSought).empty(); }

void take_axes(AppConfig& config, const std::vector<core::AxisChoice>& found) {
  for (std::size_t r = 0; r < config.regions.size() && r < found.size(); ++r) {
    core::Region& region = config.regions[r];
    if (region.axis_from != core::AxisFrom::kSought || !core::makes_channel(region.role)) continue;
    region.axis_from = found[r].from;
    region.axis_deg = found[r].axis_deg;
    region.both_axes = found[r].both_axes;
  }
}

void take_axes_of(AppConfig& config, const std::vector<core::Region>& others) {
  for (core::Region& region : config.regions) {
    const auto same =
        std::find_if(others.begin(), others.end(), [&](const auto& one) { return one.name == region.name; });
    if (region.axis_from != core::AxisFrom::kSought || same == others.end()) continue;
    region.axis_from = same->axis_from;
    region.axis_deg = same->axis_deg;
    region.both_axes = same->both_axes;
  }
}

void take_u_where_sought(AppConfig& config) {
  for (core::Region& region : config.regions)
    if (region.axis_from == core::AxisFrom::kSought) region.axis_from = core::AxisFrom::kDeclared;
}

std::string found_axes_words(const AppConfig& config) {
  std::map<std::string, std::vector<std::string>> by_axis;
  for (const core::Region& region : config.regions) {
    if (core::makes_channel(region.role) && region.axis_from == core::AxisFrom::kMotion)
      by_axis[axis_words(region)].push_back(region.name);
  }
  std::string out;
  for (const auto& [axis, names] : by_axis)
    out +=
        fmt::format("{}axis of {}: {}, found from the motion", out.empty() ? "" : "; ", fmt::join(names, ", "), axis);
  return out;
}

std::vector<std::string> axis_caveats(const AppConfig& config) {
  std::vector<std::string> out;
  if (const auto still = names_where(config, core::AxisFrom::kNoMotion); !still.empty()) {
    out.push_back(
        fmt::format("the axis of {} is not declared, and nothing moved while it was looked for: u was taken; "
                    "set regions[].axis to u, v or both",
                    fmt::join(still, ", ")));
  }
  if (const auto sought = names_where(config, core::AxisFrom::kSought); !sought.empty()) {
    out.push_back(fmt::format("the axis of {} is not declared: u was taken; set regions[].axis to u, v or both",
                              fmt::join(sought, ", ")));
  }
  return out;
}

}  // namespace app
