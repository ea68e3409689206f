#include "firmware_app/replay/analysis.h"

#include <cmath>
#include <map>
#include <stdexcept>

#include "drivers/storage/csv.h"
#include "firmware_app/replay/track_replay.h"

namespace app {

namespace {

// The points of a file by their place in its first frame, in the order of the configuration's regions.
class PointPlaces {
 public:
  PointPlaces(const drivers::TracksFile& file, const AppConfig& config) {
    for (std::size_t r = 0; r < config.regions.size(); ++r) {
      for (const core::TrackPoint& point : file.frames.front().points) {
        if (file.region_names[point.region] != config.regions[r].name) continue;
        place_of_id_[point.id] = first_.points.size();
        first_.points.push_back(point);
        first_.points.back().region = static_cast<std::uint16_t>(r);
      }
    }
    if (first_.points.empty())
      throw std::invalid_argument("the tracks have no point in any region of the configuration");
  }

  [[nodiscard]] const core::TrackFrame& first() const noexcept { return first_; }

  // All places of one frame; those without a line are not seen.
  void spread(const core::TrackFrame& frame, core::TrackFrame& out) const {
    out = first_;
    out.sequence = frame.sequence;
    out.t_start_ns = frame.t_start_ns;
    out.gap_before = frame.gap_before;
    for (core::TrackPoint& point : out.points) point.seen = false;
    for (const core::TrackPoint& point : frame.points) {
      const auto place = place_of_id_.find(point.id);
      if (place == place_of_id_.end()) continue;
      core::TrackPoint& target = out.points[place->second];
      target.u_px = point.u_px;
      target.v_px = point.v_px;
      target.sigma_px = point.sigma_px;
      target.seen = true;
    }
  }

 private:
  std::map<std::uint32_t, std::size_t> place_of_id_;
  core::TrackFrame first_;
};

core::CameraInfo camera_of(const drivers::TracksFile& file, const AppConfig& config) {
  core::CameraInfo camera = file.camera;
  if (config.camera.rate_hz > 0.0) camera.rate_hz = config.camera.rate_hz;
  // What the operator declares now overrides what the file was written with.
  if (config.camera.readout_ms != 0.0) {
    camera.readout_ns = static_cast<std::int64_t>(std::llround(config.camera.readout_ms * 1e6));
    camera.readout_direction = config.camera.readout_direction;
  }
  if (!(camera.rate_hz > 0.0)) throw std::invalid_argument("the tracks do not say their rate: set camera.rate_hz");
  return camera;
}

}  // namespace

TracksResult replay_tracks(const AppConfig& config, const std::string& tracks_path,
                           const std::string& report_directory) {
  const drivers::TracksFile file = drivers::read_tracks_csv(tracks_path);
  if (file.frames.empty()) throw std::invalid_argument(tracks_path + ": no frame");
  const core::CameraInfo camera = camera_of(file, config);
  const PointPlaces places(file, config);
  std::size_t i_frame = 0;
  const auto next = [&](core::RecordedFrame& out) {
    if (i_frame == file.frames.size()) return false;
    places.spread(file.frames[i_frame++], out.tracks);
    return true;
  };
  return replay({{config, camera, places.first(), tracks_path, next}}, report_directory);
}

}  // namespace app
