#include "firmware_app/report/plot/mode_layout.h"

#include <algorithm>
#include <cmath>

#include "firmware_app/report/plot/svg_document.h"

namespace app {
namespace {

constexpr std::size_t kMaxCaptionCharacters = 16;

ModePlace place_of(const PictureInputs& inputs, std::size_t i) {
  const core::ChannelInfo& channel = inputs.channels[i];
  ModePlace out;
  out.channel = i;
  out.is_base = channel.is_base;
  out.direction_u = channel.direction_u, out.direction_v = channel.direction_v;
  out.name = channel.name;
  out.v_px = -static_cast<double>(i);  // the first channel is lowest
  if (channel.region < inputs.regions.size()) {
    const core::Region& region = inputs.regions[channel.region];
    out.u_px = region.u_px + region.width_px / 2.0, out.v_px = region.v_px + region.height_px / 2.0;
    if (region.both_axes) out.name = region.name;
  }
  out.name = shortened(out.name, kMaxCaptionCharacters);
  return out;
}

bool is_second_axis(const PictureInputs& inputs, const ModePlace& place) {
  const std::size_t region = inputs.channels[place.channel].region;
  const bool both = region < inputs.regions.size() && inputs.regions[region].both_axes;
  return both && std::abs(place.direction_v) > std::abs(place.direction_u);
}

double spread(const std::vector<ModePlace>& places, double ModePlace::*coordinate) {
  const auto [low, high] = std::minmax_element(
      places.begin(), places.end(), [&](const auto& a, const auto& b) { return a.*coordinate < b.*coordinate; });
  return places.empty() ? 0.0 : *high.*coordinate - *low.*coordinate;
}

}  // namespace

ModeLayout mode_layout(const PictureInputs& inputs) {
  std::vector<ModePlace> places;
  ModeLayout out;
  out.in_image = !inputs.channels.empty();
  for (std::size_t i = 0; i < inputs.channels.size(); ++i) {
    places.push_back(place_of(inputs, i));
    out.in_image = out.in_image && inputs.channels[i].region < inputs.regions.size();
  }
  out.upright = spread(places, &ModePlace::v_px) >= spread(places, &ModePlace::u_px);
  for (ModePlace& place : places) {
    place.along_px = out.upright ? place.v_px : place.u_px;
    out.low_px = std::min(out.low_px, place.along_px), out.high_px = std::max(out.high_px, place.along_px);
    out.lines[is_second_axis(inputs, place) ? 1 : 0].push_back(place);
  }
  for (auto& line : out.lines) {
    std::stable_sort(line.begin(), line.end(), [](const auto& a, const auto& b) { return a.along_px < b.along_px; });
  }
  const double air = std::max(1.0, 0.06 * (out.high_px - out.low_px));
  out.low_px -= air, out.high_px += air;
  return out;
}

std::vector<ModePlace> ModeLayout::every_place() const {
  std::vector<ModePlace> out = lines[0];
  for (const ModePlace& place : lines[1]) {
    const bool there =
        std::any_of(out.begin(), out.end(), [&](const ModePlace& other) { return other.along_px == place.along_px; });
    if (!there) out.push_back(place);
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.along_px < b.along_px; });
  return out;
}

}  // namespace app
