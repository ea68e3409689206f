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
      period_hops_(static_cast<std::uint64_t>(std::max(1, config.identification.period_hops))) {}

void ChannelAnalysis::note(bool hop) {
  if (hop && cpsd_.n_hops() % period_hops_ == 0) (void)make();
}

core::ModalEstimate ChannelAnalysis::make() {
  core::ModalEstimate estimate =
      readout_use_ ? readout_use_->identify(cpsd_.sums(), readout_) : identifier_.identify(cpsd_.sums());
  if (readout_use_) tracker_.set_row_delays(readout_use_->delay_s(estimate));
  estimate.number = n_estimates_++;
  tracker_.update(estimate);
  if (report_ != nullptr) report_->add(estimate);
  return estimate;
}

bool ChannelAnalysis::push(const core::DisplacementSample& sample) {
  const core::TimeGrid::Placement placement = grid_.place(sample.t_start_ns);
  ++losses_.frames_in;
  ++losses_.frames_processed;
  if (!placement.accepted) return false;
  for (std::uint64_t k = 0; k < placement.n_missing_before; ++k) note(cpsd_.push_missing());
  losses_.frames_missing += placement.n_missing_before;
  readout_ = sample.readout;
  note(cpsd_.push(sample));
  return true;
}

core::ModalEstimate ChannelAnalysis::finish() {
  cpsd_.flush();
  losses_.samples_masked = cpsd_.sums().n_missing;
  core::ModalEstimate estimate = make();
  estimate.final = true;
  totals_.copy_totals(cpsd_.sums(), static_cast<int>(identifier_.n_outputs()));
  return estimate;
}

core::ModalEstimate ChannelAnalysis::identified(int n_differences) const {
  core::IdentifierConfig config = config_;
  config.n_differences = n_differences;
  return core::Identifier(config, identifier_.channels()).identify(cpsd_.sums());
}

TrackAnalysis::TrackAnalysis(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe)
    : displacement_(displacement_config(config, camera), keyframe),
      readout_(readout_config(config, camera), keyframe),
      sample_(displacement_.sample_prototype()),
      analysis_(config, displacement_.spectra(), camera.rate_hz) {
  analysis_.find_readout(ReadoutUse(config, camera, keyframe, displacement_.spectra()));
}

bool TrackAnalysis::push(core::TrackFrame& tracks) {
  displacement_.update(tracks, sample_);
  readout_.update(tracks);
  sample_.readout = readout_.estimate();
  return analysis_.push(sample_);
}

}  // namespace app
