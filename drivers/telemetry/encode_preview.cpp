#include <algorithm>

#include "drivers/telemetry/encode.h"
#include "drivers/telemetry/preview_jpeg.h"

namespace drivers {
namespace {

constexpr std::size_t kMostPoints = 1000;

void add_regions(const core::Preview& preview, const std::vector<core::Region>& regions, hovermodal::preview_t& out) {
  out.n_regions = to_int16(std::min(regions.size(), std::size_t{INT16_MAX}));
  for (std::size_t r = 0; r < static_cast<std::size_t>(out.n_regions); ++r) {
    const core::Region& region = regions[r];
    const core::RegionShift shift = r < preview.shifts.size() ? preview.shifts[r] : core::RegionShift{};
    out.region_u_px.push_back(static_cast<float>(region.u_px + shift.u_px));
    out.region_v_px.push_back(static_cast<float>(region.v_px + shift.v_px));
    out.region_width_px.push_back(static_cast<float>(region.width_px));
    out.region_height_px.push_back(static_cast<float>(region.height_px));
    out.region_role.push_back(static_cast<std::int8_t>(region.role));
    out.region_moved.push_back(shift.n_points > 0 ? 1 : 0);
  }
}

void add_points(const core::Preview& preview, hovermodal::preview_t& out) {
  const std::size_t step = preview.points.size() / (kMostPoints + 1) + 1;
  for (std::size_t i = 0; i < preview.points.size(); i += step) {
    const core::TrackPoint& point = preview.points[i];
    out.u_px.push_back(point.seen ? static_cast<float>(point.u_px) : kUnknown);
    out.v_px.push_back(point.seen ? static_cast<float>(point.v_px) : kUnknown);
    out.region.push_back(to_int16(point.region));
    out.inlier.push_back(point.inlier ? 1 : 0);
  }
  out.n_points = static_cast<std::int32_t>(out.u_px.size());
}

}  // namespace

hovermodal::preview_t to_message(const core::Preview& preview, const std::vector<core::Region>& regions,
                                 const StreamIdentity& identity) {
  auto out = begin_message<hovermodal::preview_t>(identity, preview.t_start_ns);
  out.frame_sequence = static_cast<std::int64_t>(preview.sequence);
  out.image_width_px = preview.image_width_px, out.image_height_px = preview.image_height_px;
  out.width_px = preview.width_px, out.height_px = preview.height_px;
  out.scale = static_cast<float>(preview.reduction);
  out.jpeg = preview_jpeg(preview);
  out.n_jpeg = static_cast<std::int32_t>(out.jpeg.size());
  add_regions(preview, regions, out);
  add_points(preview, out);
  return out;
}

}  // namespace drivers
