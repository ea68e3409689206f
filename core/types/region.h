#pragma once

#include <cstdint>
#include <string>

#include "core/types/vector2.h"

namespace core {

// kBase moves with the structure's ground; kGround is static, in the structure's plane; kBackground is static,
// elsewhere.
enum class RegionRole : std::uint8_t { kStructure, kBase, kBackground, kGround };

// Static regions have no displacement.
[[nodiscard]] constexpr bool makes_channel(RegionRole role) noexcept {
  return role == RegionRole::kStructure || role == RegionRole::kBase;
}

// State of a region in the newest frame. Searching: not measured, but expected in the image. Lost: outside the image,
// or searched for too long; it is measured again as soon as it is found.
enum class RegionState : std::uint8_t { kMeasuring, kSearching, kLost };

[[nodiscard]] constexpr const char* to_string(RegionState state) noexcept {
  switch (state) {
    case RegionState::kMeasuring:
      return "measuring";
    case RegionState::kSearching:
      return "searching";
    case RegionState::kLost:
      return "lost";
  }
  return "";
}

// Where the axis of a region comes from: declared; to be found from the motion of the first seconds (until then u);
// found there; or nothing moved there, and u was taken.
enum class AxisFrom : std::uint8_t { kDeclared, kSought, kMotion, kNoMotion };

// A rectangle of the first image whose points move together: a floor, a deck panel, a wall behind.
struct Region {
  std::string name;
  double u_px = 0.0, v_px = 0.0, width_px = 0.0, height_px = 0.0;  // top-left corner and size
  RegionRole role = RegionRole::kStructure;
  // Axis of the displacement in the image: angle from +u towards +v (down). `both` gives two channels, u and v.
  double axis_deg = 0.0;
  bool both_axes = false;
  AxisFrom axis_from = AxisFrom::kDeclared;
  // A length known here, between two points of the first image: the region's own scale. 0 = none.
  double length_mm = 0.0;
  Vector2 length_from_px{}, length_to_px{};
  double depth_m = 0.0;  // background: distance along the optical axis in the first image; 0 = unknown
};

}  // namespace core
