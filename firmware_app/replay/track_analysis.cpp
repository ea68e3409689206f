#include "firmware_app/replay/track_analysis.h"

#include <utility>

#include "firmware_app/chain/makers.h"
#include "firmware_app/config/core_config.h"
#include "firmware_app/report/run_report.h"

namespace app {

namespace {

const CorrectionLog& nothing_taken_out() {
  static const CorrectionLog book;
  return book;
}

core::WelchConfig welch_of(const AppConfig& config, const std::vector<core::ChannelInfo>& channels, double rate_hz,
                           const ModeIdentification& modes) {
  const auto n_outputs = static_cast<std::size_t>(modes.identifier().n_outputs());
  return welch_config(config.spectrum, channels.size(), rate_hz, channels.size() - n_outputs);
}

}  // namespace

ChannelAnalysis::ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels,
                                 double rate_hz)
    : ChannelAnalysis(
          config, channels, rate_hz,
          [config, channels](double rate, const CorrectionSet&) {
            return std::make_unique<const ReadoutAwareIdentifier>(config, rate, channels);
          },
          nothing_taken_out()) {}

ChannelAnalysis::ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels,
                                 double rate_hz, ModeIdentification::MakeIdentifier make_identifier,
                                 const CorrectionLog& book)
    : config_(identifier_config(config, channels, rate_hz)),
      channels_(channels),
      modes_(rate_hz, std::move(make_identifier), book, motor_lines(config)),
      spectra_(welch_of(config, channels, rate_hz, modes_), config.identification.period_hops),
      snapshot_{spectra_.sums()} {}

void ChannelAnalysis::go_on_from(ChannelAnalysis& earlier) {
  spectra_.go_on_from(earlier.spectra_);
  modes_.go_on_from(earlier.modes_);
  losses_ = earlier.losses_;
}

bool ChannelAnalysis::resume(const RunState& state) noexcept {
  if (!spectra_.resume(state.spectrum, !state.boot_id.empty())) return false;
  (void)modes_.resume(state.modes);  // else mode tracking starts again, as in the run
  return true;
}

bool ChannelAnalysis::push(const core::DisplacementSample& sample) {
  for (bool is_done = false; !is_done; identify_when_due()) is_done = spectra_.step(sample);
  ++losses_.frames_in;
  ++losses_.frames_processed;
  losses_.frames_missing = spectra_.n_missing();
  return !spectra_.refused();
}

void ChannelAnalysis::identify_when_due() {
  if (!spectra_.is_due()) return;
  spectra_.take_snapshot(snapshot_);
  modes_.identify(snapshot_, result_);
  if (report_ != nullptr) report_->add(result_.estimate, result_.aircraft);
}

core::ModalEstimate ChannelAnalysis::finish() {
  spectra_.finish();
  losses_.samples_masked = spectra_.n_masked();
  identify_when_due();
  return result_.estimate;
}

SetupSums ChannelAnalysis::setup_sums() const {
  SetupSums out;
  out.record = {snapshot_.sums, modes_.identifier().channels()};
  out.basis = modes_.identifier().basis();
  out.from_tracks = snapshot_.readout;
  return out;
}

core::ModalEstimate ChannelAnalysis::identified(int n_differences) const {
  core::IdentifierConfig config = config_;
  config.n_differences = n_differences;
  return core::Identifier(config, channels_).identify(spectra_.sums());
}

TrackAnalysis::TrackAnalysis(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe)
    : config_(config),
      camera_(camera),
      keyframe_(keyframe),
      declared_(make_geometry(config, camera, keyframe, {})),
      lattice_(keyframe_),
      meter_(declared_->displacement, declared_->readout,
             config.closure.adopt == ClosureAdopt::kAuto ? &lattice_ : nullptr),
      sample_(declared_->displacement.sample_prototype()),
      analysis_(config, declared_->displacement.spectra(), camera.rate_hz,
                identifier_maker(config_, camera_, keyframe_, declared_->displacement.spectra()), book_) {
  if (config.closure.adopt != ClosureAdopt::kOff) {
    diagnosis_.emplace(missing_effect_search_config(config, camera, keyframe), book_,
                       geometry_maker(config_, camera_, keyframe_),
                       past_of(config_, camera_, keyframe_, declared_->displacement));
  }
}

bool TrackAnalysis::push(core::TrackFrame& tracks, std::uint32_t stride) {
  begin_frame(tracks.sequence);
  meter_.measure(tracks, stride, sample_);
  const bool accepted = analysis_.push(sample_);
  if (diagnosis_) {
    diagnosis_->take(tracks, stride);
    if (diagnosis_->is_due()) report(false);
  }
  return accepted;
}

void TrackAnalysis::begin_frame(std::uint64_t sequence) {
  if (Rebuild* coming = meter_.coming(); coming != nullptr && coming->is_due(sequence)) (void)coming->offer(true);
  if (meter_.begin_frame(sequence) && meter_.rebuilt() != nullptr) analysis_.take_over(*meter_.rebuilt());
}

void TrackAnalysis::report(bool final) {
  const core::closure::ClosureReport report = diagnosis_->report(final);
  const CorrectionSwitch change = diagnosis_->change();
  if (change.rebuilt != nullptr) change.rebuilt->announce(change.from_sequence);
  meter_.take(change);
  if (hear_closure_) hear_closure_(report);
}

core::ModalEstimate TrackAnalysis::finish() {
  if (diagnosis_ && diagnosis_->is_left()) report(true);
  return analysis_.finish();
}

}  // namespace app
