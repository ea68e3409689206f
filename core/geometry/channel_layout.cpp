#include "core/geometry/channel_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/geometry/keyframe_view.h"
#include "core/types/witness.h"

namespace core {

Vector2 centre_of(std::span<const Vector2> points) noexcept {
  const auto n = static_cast<double>(points.size());
  Vector2 centre;
  for (const Vector2& p : points) centre.u += p.u / n, centre.v += p.v / n;
  return centre;
}

std::string_view without_axis(std::string_view channel) noexcept {
  if (channel.ends_with(".u") || channel.ends_with(".v")) channel.remove_suffix(2);
  return channel;
}

std::vector<ChannelInfo> channel_layout(const std::vector<Region>& regions, const std::vector<RegionPoints>& points) {
  std::vector<ChannelInfo> out;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const Region& region = regions[r];
    if (!makes_channel(region.role)) continue;
    ChannelInfo info{static_cast<std::uint16_t>(r),   region.name, 1.0, 0.0, points[r].delay_s,
                     region.role == RegionRole::kBase};
    if (!region.both_axes) {
      const Vector2 axis = axis_of(region);
      info.direction_u = axis.u;
      info.direction_v = axis.v;
      out.push_back(info);
      continue;
    }
    info.name = region.name + ".u";
    out.push_back(info);
    info.name = region.name + ".v";
    info.direction_u = 0.0;
    info.direction_v = 1.0;
    out.push_back(info);
  }
  return out;
}

std::vector<ChannelInfo> witness_layout(const std::vector<Region>& regions, const std::vector<RegionPoints>& points,
                                        const std::vector<ChannelInfo>& channels, const WitnessNeeds& needs) {
  constexpr double kSameDirection = 0.99;
  std::vector<ChannelInfo> out;
  std::size_t best = regions.size(), most = static_cast<std::size_t>(std::max(3, needs.min_points)) - 1;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (!makes_channel(regions[r].role) && points[r].n > most) best = r, most = points[r].n;
  }
  if (best == regions.size()) return out;
  for (const ChannelInfo& channel : channels) {
    const auto is_alike = [&](const ChannelInfo& other) {
      return std::abs(cosine_between(other, channel)) > kSameDirection;
    };
    if (std::any_of(out.begin(), out.end(), is_alike)) continue;
    ChannelInfo info{static_cast<std::uint16_t>(best), regions[best].name, channel.direction_u, channel.direction_v,
                     points[best].delay_s};
    info.is_witness = true;
    out.push_back(std::move(info));
  }
  if (!(needs.least_spread_px > 0.0) || points[best].spread_px < needs.least_spread_px) return out;
  ChannelInfo turn{static_cast<std::uint16_t>(best), regions[best].name, 0.0, 0.0, points[best].delay_s};
  turn.is_witness = true;
  out.push_back(std::move(turn));
  return out;
}

}  // namespace core
