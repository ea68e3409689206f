#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/region.h"
#include "core/types/vector2.h"

namespace core {

// Properties of a region's points that its channels need.
struct RegionPoints {
  std::size_t n = 0;
  double delay_s = 0.0;    // after the time stamp: weighted mean over the points' rows
  double spread_px = 0.0;  // spread_of_turn_px() of the points
};

// 0 without points.
[[nodiscard]] Vector2 centre_of(std::span<const Vector2> points) noexcept;

// Channels of the structure and base regions, in their order: one along the region's axis, or two (u, v).
[[nodiscard]] std::vector<ChannelInfo> channel_layout(const std::vector<Region>& regions,
                                                      const std::vector<RegionPoints>& points);

// The region of a channel called REGION.u or REGION.v, by its name; else the name itself.
[[nodiscard]] std::string_view without_axis(std::string_view channel) noexcept;

// What a region needs to be a witness.
struct WitnessNeeds {
  int min_points = 3;            // 3 or more
  double least_spread_px = 0.0;  // of its points, to witness the camera's rotation; 0: none does
};

// Witnesses of the camera's translation along each direction of the channels, and of its rotation about the optical
// axis (witnesses_turn()): the static region with the most points; empty without one.
[[nodiscard]] std::vector<ChannelInfo> witness_layout(const std::vector<Region>& regions,
                                                      const std::vector<RegionPoints>& points,
                                                      const std::vector<ChannelInfo>& channels,
                                                      const WitnessNeeds& needs);

}  // namespace core
