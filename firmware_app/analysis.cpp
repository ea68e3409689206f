#include "firmware_app/analysis.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "core/geometry/channel_displacement.h"
#include "core/identification/mode_tracker.h"
#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "drivers/storage/csv.h"
#include "firmware_app/core_config.h"
#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_report.h"
#include "firmware_app/run_findings.h"

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

// Estimates at the hops where the service makes them, so that the modes get the same history.
class Estimates {
 public:
  Estimates(const AppConfig& config, const std::vector<core::ChannelInfo>& channels, double rate_hz, RunReport* report)
      : identifier_(identifier_config(config, channels, rate_hz), channels),
        tracker_({.row_delay_s = identifier_.undone_delay_s()}),
        period_hops_(static_cast<std::uint64_t>(std::max(1, config.identification.period_hops))),
        report_(report) {}

  void note(bool hop, const core::WelchCpsd& cpsd) {
    if (hop && cpsd.n_hops() % period_hops_ == 0) (void)make(cpsd.sums());
  }
  [[nodiscard]] core::ModalEstimate make(const core::CpsdSums& sums) {
    core::ModalEstimate estimate = identifier_.identify(sums);
    estimate.number = n_++;
    tracker_.update(estimate);
    if (report_ != nullptr) report_->add(estimate);
    return estimate;
  }

 private:
  core::Identifier identifier_;
  core::ModeTracker tracker_;
  std::uint64_t period_hops_, n_ = 0;
  RunReport* report_;
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
  core::ChannelDisplacement displacement(displacement_config(config, camera), places.first());

  TracksResult result;
  result.channels = displacement.channels();
  std::unique_ptr<RunReport> report;
  if (!report_directory.empty()) {
    report = std::make_unique<RunReport>(report_directory, config, camera, result.channels, region_names(config));
  }
  core::WelchCpsd cpsd(welch_config(config.spectrum, result.channels.size(), camera.rate_hz));
  Estimates estimates(config, result.channels, camera.rate_hz, report.get());
  core::TimeGrid grid(camera.rate_hz);
  core::DisplacementSample sample = displacement.sample_prototype();
  core::TrackFrame tracks;
  for (const core::TrackFrame& frame : file.frames) {
    places.spread(frame, tracks);
    displacement.update(tracks, sample);
    const core::TimeGrid::Placement placement = grid.place(frame.t_start_ns);
    ++result.losses.frames_in;
    ++result.losses.frames_processed;
    if (!placement.accepted) continue;
    for (std::uint64_t k = 0; k < placement.n_missing_before; ++k) estimates.note(cpsd.push_missing(), cpsd);
    result.losses.frames_missing += placement.n_missing_before;
    estimates.note(cpsd.push(sample.value_mm, sample.seen), cpsd);
    if (report) (void)(report->add(tracks) && report->add(sample));
  }
  cpsd.flush();
  result.losses.samples_masked = cpsd.sums().n_missing;
  result.estimate = estimates.make(cpsd.sums());
  result.estimate.final = true;
  if (!report) return result;
  report->finish(result.estimate, result.losses, corrections(config, camera));
  const RunFacts facts = run_facts(config, camera, tracks_path, result.losses);
  PictureInputs inputs = picture_inputs(config, camera, result.channels);
  inputs.keyframe = &places.first();
  inputs.spectrum = &cpsd.sums();
  inputs.estimate = &result.estimate;
  inputs.history = &report->history();
  inputs.facts = &facts;
  (void)write_pictures(report_directory, inputs);
  return result;
}

}  // namespace app
