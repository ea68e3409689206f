#include "firmware_app/service/found_axes.h"

#include <chrono>

#include "firmware_app/config/axis_search.h"
#include "firmware_app/config/config_table.h"
#include "firmware_app/config/region_axis.h"
#include "firmware_app/service/source.h"

namespace app {
namespace {

// As fast as it can be read, and without the state of an earlier run.
AppConfig to_look_at(const AppConfig& declared) {
  AppConfig config = declared;
  config.camera.pace = Pace::kAsFastAsPossible;
  config.state.directory.clear();
  return config;
}

}  // namespace

AppConfig with_found_axes(const AppConfig& declared) {
  if (!seeks_axes(declared)) return declared;
  const AppConfig looking = to_look_at(declared);
  Source source(open_camera(looking), looking);
  core::Frame frame = source.first_frame;
  core::TrackFrame tracks = source.keyframe;
  AxisSearch search(looking, tracks.points.size());
  while (!search.is_settled_by(tracks)) {
    if (source.camera->capture(frame, kFrameTimeout) != drivers::CaptureStatus::kFrame) break;
    if (!source.tracker.track(frame, tracks)) break;
    for (core::TrackPoint& point : tracks.points) point.inlier = point.seen;
    source.tracker.learn(tracks);
  }
  source.camera->stop();
  AppConfig found = declared;
  search.take(found);
  found.hash = canonical_hash(found);  // a state of another axis is not gone on with
  return found;
}

}  // namespace app
