#include "firmware_app/analysis.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "drivers/storage/csv.h"
#include "firmware_app/core_config.h"
#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_report.h"
#include "firmware_app/run_findings.h"
#include "firmware_app/track_analysis.h"

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
  TrackAnalysis run(config, camera, places.first());

  TracksResult result;
  result.channels = run.channels();
  std::unique_ptr<RunReport> report;
  if (!report_directory.empty()) {
    report = std::make_unique<RunReport>(report_directory, config, camera, result.channels, region_names(config));
  }
  ChannelAnalysis& analysis = run.analysis();
  analysis.report_to(report.get());
  std::optional<core::closure::ClosureReport> closure;
  run.hear_closure([&](const core::closure::ClosureReport& last) {
    closure = last;
    result.changes.insert(result.changes.end(), last.changes.begin(), last.changes.end());
  });
  core::TrackFrame tracks;
  for (const core::TrackFrame& frame : file.frames) {
    places.spread(frame, tracks);
    const bool accepted = run.push(tracks);
    if (accepted && report) (void)(report->add(tracks) && report->add(run.sample()));
  }
  result.estimate = run.finish();
  result.losses = analysis.losses();
  result.n_differences = analysis.n_differences();
  if (!report) return result;
  report->finish(result.estimate, result.losses, corrections(config, camera), caveats(config, camera),
                 closure ? &*closure : nullptr);
  const RunFacts facts = run_facts(config, camera, tracks_path, result.losses, result.estimate);
  PictureInputs inputs = picture_inputs(config, camera, result.channels);
  inputs.keyframe = &places.first();
  inputs.spectrum = &analysis.sums();
  inputs.estimate = &result.estimate;
  inputs.history = &report->history();
  inputs.closure = closure ? &*closure : nullptr;
  inputs.facts = &facts;
  (void)write_pictures(report_directory, inputs);
  return result;
}

}  // namespace app
