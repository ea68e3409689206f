#include "firmware_app/replay/analysis.h"

#include "drivers/storage/tracks_file.h"
#include "firmware_app/replay/point_places.h"
#include "firmware_app/replay/run_folder.h"
#include "firmware_app/replay/track_replay.h"
#include "firmware_app/replay/tracks_axes.h"

namespace app {

TracksResult replay_tracks(const AppConfig& declared, const std::string& tracks_path,
                           const std::string& report_directory, const FrameProgress& progress) {
  const drivers::TracksFile file = drivers::read_tracks_csv(tracks_path);
  const AppConfig config = with_axes_of(file, declared);
  const core::CameraInfo camera = camera_of_tracks(file, config);
  const PointPlaces places(file, config);
  drivers::TracksPass frames(file);
  core::TrackFrame frame;
  std::uint64_t n_done = 0;
  const auto next = [&](core::RecordedFrame& out) {
    if (!frames.next(frame)) return false;
    places.spread(frame, out.tracks);
    if (progress) progress(++n_done, file.n_frames);
    return true;
  };
  return replay({{config, camera, places.first(), tracks_path, next}}, report_directory);
}

}  // namespace app
