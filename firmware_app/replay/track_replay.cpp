#include "firmware_app/replay/track_replay.h"

#include <fmt/core.h>

#include <memory>
#include <optional>
#include <stdexcept>

#include "firmware_app/chain/state/run_view.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/replay/track_analysis.h"
#include "firmware_app/report/modal_json.h"
#include "firmware_app/report/pictures/pictures.h"
#include "firmware_app/report/run_findings.h"
#include "firmware_app/report/run_report.h"

namespace app {

namespace {

// The geometry refers to a region by its number, and expects the points of a region to be adjacent.
void require_regions(const TrackSource& source) {
  const std::size_t n_regions = source.config.regions.size();
  std::uint16_t last = 0;
  for (const core::TrackPoint& point : source.keyframe.points) {
    if (point.region >= n_regions || point.region < last) {
      throw std::invalid_argument(
          fmt::format("{}: a point of region number {} does not belong to the {} regions of the configuration; replay "
                      "it with the one it was recorded with",
                      source.name, point.region, n_regions));
    }
    last = point.region;
  }
}

class Replay {
 public:
  explicit Replay(const std::string& report_directory) : report_directory_(report_directory) {}

  void run(const TrackSource& source, bool is_alone) {
    begin(source);
    core::RecordedFrame frame;
    frame.tracks = source.keyframe;
    while (source.next(frame)) {
      for (std::size_t i = 0; i < frame.attitude.n; ++i) analysis_->take(frame.attitude.samples[i]);
      if (source.aircraft) take_aircraft(source.aircraft());
      const bool accepted = analysis_->push(frame.tracks, frame.stride);
      if (accepted && report_ && is_alone) (void)(report_->add(frame.tracks) && report_->add(analysis_->sample()));
    }
  }

  [[nodiscard]] TracksResult finish(const TrackSource& last, bool is_alone) {
    result_.channels = analysis_->channels();
    result_.estimate = analysis_->finish();
    result_.losses = analysis_->analysis().losses();
    if (is_alone && last.account) take_account(last.account());
    result_.sums = analysis_->analysis().setup_sums();
    result_.sums.view = view_;
    result_.n_differences = analysis_->analysis().n_differences();
    result_.method = to_text(last.config.method);
    if (report_) write_report(last);
    return std::move(result_);
  }

 private:
  void take_aircraft(const core::AircraftBatch& batch) {
    for (std::size_t i = 0; i < batch.n; ++i) analysis_->take(batch.states[i]);
  }

  void begin(const TrackSource& source) {
    require_regions(source);
    auto next = std::make_unique<TrackAnalysis>(source.config, source.camera, source.keyframe);
    RunState view = run_view(source.config, source.camera, next->channels());
    view.config_hash = 0;  // the source's name is part of it
    if (analysis_) {
      if (const std::string why = why_foreign(view_, view); !why.empty())
        throw std::invalid_argument(
            fmt::format("{}: does not continue the record before it: {}; replay them one by one", source.name, why));
      next->go_on_from(*analysis_);
    } else {
      if (source.resumed != nullptr && !next->resume(*source.resumed))
        throw std::invalid_argument(source.name + ": the state that the run went on with is damaged in the record");
      if (!report_directory_.empty())
        report_ = std::make_unique<RunReport>(report_directory_, source.config, source.camera, next->channels(),
                                              region_names(source.config));
      if (report_ && source.resumed != nullptr) report_->set_recovered();
    }
    view_ = std::move(view);
    analysis_ = std::move(next);
    analysis_->analysis().report_to(report_.get());
    analysis_->hear_closure([this](const core::closure::ClosureReport& report) {
      closure_ = report;
      result_.changes.insert(result_.changes.end(), report.changes.begin(), report.changes.end());
    });
  }

  // Losses before the record was written, where the record contains everything that was processed.
  void take_account(const RunAccount& account) {
    result_.losses.times = account.times;
    const std::optional<core::RunCounts>& counts = account.counts;
    if (!counts || counts->frames_processed != result_.losses.frames_processed) return;
    result_.losses.frames_in = counts->frames_in;
    result_.losses.frames_dropped = counts->frames_dropped;
    result_.losses.frames_missing = counts->frames_missing;
    result_.losses.snapshots_skipped = counts->snapshots_skipped;
  }

  void write_report(const TrackSource& last) {
    const core::closure::ClosureReport* closure = closure_ ? &*closure_ : nullptr;
    const RunFacts facts =
        run_facts(last.config, last.camera, last.name, result_.losses, result_.estimate, analysis_->axes());
    PictureInputs inputs = picture_inputs(last.config, last.camera, result_.channels);
    inputs.first_frame = last.image;
    inputs.keyframe = &last.keyframe;
    inputs.spectrum = &analysis_->analysis().sums();
    inputs.estimate = &result_.estimate;
    inputs.history = &report_->history();
    inputs.closure = closure;
    inputs.facts = &facts;
    report_->finish(result_.estimate, result_.losses, corrections(last.config, last.camera), facts.caveats, closure,
                    [&](const std::string& folder) { (void)write_pictures(folder, inputs); });
  }

  std::string report_directory_;
  std::unique_ptr<TrackAnalysis> analysis_;  // of the current run
  RunState view_;
  std::unique_ptr<RunReport> report_;  // null: not requested
  std::optional<core::closure::ClosureReport> closure_;
  TracksResult result_;
};

}  // namespace

TracksResult replay(const std::vector<TrackSource>& runs, const std::string& report_directory) {
  Replay replay(report_directory);
  for (const TrackSource& run : runs) replay.run(run, runs.size() == 1);
  return replay.finish(runs.back(), runs.size() == 1);
}

}  // namespace app
