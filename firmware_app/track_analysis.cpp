#include "firmware_app/track_analysis.h"

#include <algorithm>
#include <utility>

#include "firmware_app/core_config.h"
#include "firmware_app/report/run_report.h"

namespace app {

ChannelAnalysis::ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels,
                                 double rate_hz)
    : config_(identifier_config(config, channels, rate_hz)),
      identifier_(config_, channels),
      tracker_({.row_delay_s = identifier_.undone_delay_s()}),
      cpsd_(welch_config(config.spectrum, channels.size(), rate_hz, channels.size() - identifier_.n_outputs())),
      grid_(rate_hz),
      rate_hz_(rate_hz),
      period_hops_(static_cast<std::uint64_t>(std::max(1, config.identification.period_hops))) {}

void ChannelAnalysis::note(bool hop) {
  if (hop && cpsd_.n_hops() % period_hops_ == 0) (void)make();
}

core::ModalEstimate ChannelAnalysis::make() {
  core::ModalEstimate estimate =
      readout_use_ ? readout_use_->identify(cpsd_.sums(), readout_) : identifier_.identify(cpsd_.sums());
  estimate.amendments = amendments_;
  if (readout_use_) tracker_.set_row_delays(readout_use_->delay_s(estimate));
  estimate.number = n_estimates_++;
  tracker_.update(estimate);
  if (report_ != nullptr) report_->add(estimate);
  return estimate;
}

void ChannelAnalysis::amend(ReadoutUse use, const Amendment& amendment) {
  const bool begins = amendment.begins_record;
  if (begins) {
    if (cpsd_.sums().n_segments > 0) (void)make();
    n_masked_before_ += cpsd_.sums().n_missing;
    cpsd_.restart(rate_hz_);
    tracker_.restart();
  }
  readout_use_.emplace(std::move(use));
  amendments_ = amendment.words;
  for (int k = 0; !begins && k < cpsd_.sums().n_fft / 2; ++k) note(cpsd_.push_missing());
}

void ChannelAnalysis::go_on_from(ChannelAnalysis& earlier) {
  std::swap(tracker_, earlier.tracker_);
  std::swap(cpsd_, earlier.cpsd_);
  losses_ = earlier.losses_;
  n_masked_before_ = earlier.n_masked_before_;
  n_estimates_ = earlier.n_estimates_;
  for (int k = 0; k < cpsd_.sums().n_fft / 2; ++k) note(cpsd_.push_missing());
}

bool ChannelAnalysis::push(const core::DisplacementSample& sample) {
  const core::TimeGrid::Placement placement = grid_.place(sample.t_start_ns);
  ++losses_.frames_in;
  ++losses_.frames_processed;
  if (!placement.accepted) return false;
  // As the service: after two segments without a sample, more masked cells would only add empty segments. A record's
  // stamps may lie years apart.
  const std::uint64_t n_masked =
      std::min<std::uint64_t>(placement.n_missing_before, 2 * static_cast<std::uint64_t>(cpsd_.sums().n_fft));
  for (std::uint64_t k = 0; k < n_masked; ++k) note(cpsd_.push_missing());
  losses_.frames_missing += placement.n_missing_before;
  readout_ = sample.readout;
  note(cpsd_.push(sample));
  return true;
}

core::ModalEstimate ChannelAnalysis::finish() {
  cpsd_.flush();
  losses_.samples_masked = n_masked_before_ + cpsd_.sums().n_missing;
  core::ModalEstimate estimate = make();
  estimate.final = true;
  totals_.copy_totals(cpsd_.sums(), static_cast<int>(identifier_.n_outputs()));
  return estimate;
}

ViewSums ChannelAnalysis::view_sums() const {
  ViewSums out;
  out.record = {cpsd_.sums(), readout_use_.value().channels()};
  out.basis = readout_use_->basis();
  out.from_tracks = readout_;
  return out;
}

core::ModalEstimate ChannelAnalysis::identified(int n_differences) const {
  core::IdentifierConfig config = config_;
  config.n_differences = n_differences;
  return core::Identifier(config, identifier_.channels()).identify(cpsd_.sums());
}

TrackAnalysis::TrackAnalysis(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe)
    : config_(config),
      camera_(camera),
      keyframe_(keyframe),
      geometry_(make_geometry(config, camera, keyframe, {})),
      sample_(geometry_->displacement.sample_prototype()),
      analysis_(config, geometry_->displacement.spectra(), camera.rate_hz) {
  analysis_.find_readout(ReadoutUse(config, camera, keyframe, geometry_->displacement.spectra()));
  if (config.closure.adopt == ClosureAdopt::kAuto) loop_.emplace(loop_closer_config(config, camera, keyframe));
}

void TrackAnalysis::go_on_from(TrackAnalysis& earlier) { analysis_.go_on_from(earlier.analysis_); }

bool TrackAnalysis::push(core::TrackFrame& tracks) {
  begin_amendment(tracks.sequence);
  geometry_->displacement.update(tracks, sample_);
  geometry_->readout.update(tracks);
  sample_.readout = geometry_->readout.estimate();
  const bool accepted = analysis_.push(sample_);
  if (loop_) close_loop(tracks);
  return accepted;
}

void TrackAnalysis::close_loop(const core::TrackFrame& tracks) {
  loop_->take(tracks);
  if (!loop_->is_due()) return;
  const core::closure::ClosureReport report = loop_->report(false);
  if (auto amendment = loop_->amendment(); amendment && !book_.full()) pending_ = book_.add(std::move(*amendment));
  if (hear_closure_) hear_closure_(report);
}

void TrackAnalysis::begin_amendment(std::uint64_t sequence) {
  if (!pending_ || sequence < pending_->from_sequence) return;
  geometry_ = make_geometry(config_, camera_, keyframe_, *pending_);
  sample_.amendment = pending_->number, sample_.record = pending_->record;
  analysis_.amend(ReadoutUse(pending_->applied(config_, camera_.rate_hz), pending_->applied(camera_), keyframe_,
                             geometry_->displacement.spectra()),
                  *pending_);
  pending_.reset();
}

core::ModalEstimate TrackAnalysis::finish() {
  if (loop_ && loop_->is_left()) {
    const core::closure::ClosureReport report = loop_->report(true);
    if (hear_closure_) hear_closure_(report);
  }
  return analysis_.finish();
}

}  // namespace app
