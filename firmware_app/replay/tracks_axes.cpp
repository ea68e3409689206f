#include "firmware_app/replay/tracks_axes.h"

#include "firmware_app/config/axis_search.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/replay/point_places.h"

namespace app {
namespace {

std::vector<core::Region> regions_of(const drivers::TracksFile& file) {
  std::vector<core::Region> out;
  for (std::size_t r = 0; r < file.region_axes.size() && r < file.region_names.size(); ++r) {
    core::Region region = undeclared_region();
    region.name = file.region_names[r];
    if (put_axis(file.region_axes[r], region)) out.push_back(region);
  }
  return out;
}

}  // namespace

AppConfig with_axes_of(const drivers::TracksFile& file, AppConfig config) {
  if (!seeks_axes(config)) return config;
  take_axes_of(config, regions_of(file));
  if (!seeks_axes(config)) return config;
  const PointPlaces places(file, config);
  AxisSearch search(config, places.first().points.size());
  core::TrackFrame points = places.first();
  drivers::TracksPass frames(file);
  for (core::TrackFrame frame; frames.next(frame);) {
    places.spread(frame, points);
    if (search.is_settled_by(points)) break;
  }
  search.take(config);
  return config;
}

}  // namespace app
