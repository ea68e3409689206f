#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "core/types/region.h"

namespace core {

// Names in configurations, and in pictures and tables.
inline constexpr std::array<std::pair<RegionRole, std::string_view>, 4> kRoleNames{
    {{RegionRole::kStructure, "structure"},
     {RegionRole::kBase, "base"},
     {RegionRole::kBackground, "background"},
     {RegionRole::kGround, "ground"}}};

[[nodiscard]] constexpr std::string_view to_string(RegionRole role) noexcept {
  for (const auto& [one, name] : kRoleNames)
    if (one == role) return name;
  return "";
}

}  // namespace core
