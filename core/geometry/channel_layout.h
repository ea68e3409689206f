#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "core/types/displacement.h"
#include "core/types/region.h"

namespace core {

// Properties of a region's points that its channels need.
struct RegionPoints {
  std::size_t n = 0;
  double delay_s = 0.0;  // after the time stamp: weighted mean over the points' rows
};

// Channels of the structure and base regions, in their order: one along the region's axis, or two (u, v).
[[nodiscard]] std::vector<ChannelInfo> channel_layout(const std::vector<Region>& regions,
                                                      const std::vector<RegionPoints>& points);

// The region of a channel called REGION.u or REGION.v, by its name; else the name itself.
[[nodiscard]] std::string_view without_axis(std::string_view channel) noexcept;

// Witnesses of the camera's translation along each direction of the channels: the static region with the most points,
// at least min_points (3 or more); empty without one.
[[nodiscard]] std::vector<ChannelInfo> witness_layout(const std::vector<Region>& regions,
                                                      const std::vector<RegionPoints>& points,
                                                      const std::vector<ChannelInfo>& channels, int min_points);

}  // namespace core
