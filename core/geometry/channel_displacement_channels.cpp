// What channels and witnesses there are; set-up only.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/keyframe_view.h"

namespace core {

// Of the same weighted mean as the channel's.
double ChannelDisplacement::delay_s(const RegionRange& range) const noexcept {
  double share = 0.0, weight = 0.0;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    share += weight_[i] * readout_share_[i];
    weight += weight_[i];
  }
  return weight > 0.0 && !config_.paper_method ? config_.readout.readout_s * share / weight : 0.0;
}

// The camera's velocity against the structure is told where the structure itself does not vibrate: at its base. Where
// none is declared, all of its points are taken; part of every mode's own velocity is then in their mean.
PublishedShutter ChannelDisplacement::make_published_shutter() const {
  const std::vector<Region>& all = config_.regions;
  const bool has_base =
      std::any_of(all.begin(), all.end(), [](const Region& region) { return region.role == RegionRole::kBase; });
  std::vector<PublishedShutter::Region> regions;
  for (std::size_t r = 0; r < ranges_.size(); ++r) {
    const bool follows = has_base ? all[r].role == RegionRole::kBase : makes_channel(all[r].role);
    regions.push_back({ranges_[r].begin, ranges_[r].end, follows});
  }
  return {config_.shutter_velocity, std::move(regions), keyframe_.size()};
}

void ChannelDisplacement::make_witnesses() {
  constexpr double kSameDirection = 0.99;
  std::size_t best = ranges_.size(), most = static_cast<std::size_t>(std::max(3, config_.min_points)) - 1;
  for (std::size_t r = 0; r < ranges_.size(); ++r) {
    const std::size_t n = ranges_[r].size();
    if (!makes_channel(config_.regions[r].role) && n > most) best = r, most = n;
  }
  if (best == ranges_.size()) return;
  for (const ChannelInfo& channel : channels_) {
    const auto is_alike = [&](const ChannelInfo& other) {
      return other.is_witness && std::abs(other.direction_u * channel.direction_u +
                                          other.direction_v * channel.direction_v) > kSameDirection;
    };
    if (std::any_of(spectra_.begin(), spectra_.end(), is_alike)) continue;
    ChannelInfo info{static_cast<std::uint16_t>(best), config_.regions[best].name, channel.direction_u,
                     channel.direction_v, delay_s(ranges_[best])};
    info.is_witness = true;
    spectra_.push_back(std::move(info));
  }
}

void ChannelDisplacement::make_channels() {
  for (std::size_t r = 0; r < config_.regions.size(); ++r) {
    const Region& region = config_.regions[r];
    if (!makes_channel(region.role)) continue;
    ChannelInfo info{static_cast<std::uint16_t>(r),   region.name, 1.0, 0.0, delay_s(ranges_[r]),
                     region.role == RegionRole::kBase};
    if (!region.both_axes) {
      const Vector2 axis = axis_of(region);
      info.direction_u = axis.u;
      info.direction_v = axis.v;
      channels_.push_back(info);
      continue;
    }
    info.name = region.name + ".u";
    channels_.push_back(info);
    info.name = region.name + ".v";
    info.direction_u = 0.0;
    info.direction_v = 1.0;
    channels_.push_back(info);
  }
}

DisplacementSample ChannelDisplacement::sample_prototype() const {
  DisplacementSample sample;
  sample.value_mm.assign(channels_.size(), 0.0);
  sample.sigma_mm.assign(channels_.size(), 0.0);
  sample.seen.assign(channels_.size(), 0);
  sample.n_points.assign(channels_.size(), 0);
  sample.witness_mm.assign(n_witnesses(), 0.0);
  sample.witness_seen.assign(n_witnesses(), 0);
  return sample;
}

}  // namespace core
