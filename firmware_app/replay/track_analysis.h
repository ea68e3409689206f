#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/identification/identifier.h"
#include "core/identification/prewhitening.h"
#include "core/rotors/aircraft.h"
#include "core/types/attitude.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/track.h"
#include "firmware_app/chain/diagnosis.h"
#include "firmware_app/chain/displacement_meter.h"
#include "firmware_app/chain/mode_identification.h"
#include "firmware_app/chain/rebuild.h"
#include "firmware_app/chain/spectrum_accumulator.h"
#include "firmware_app/chain/state/setup_sums.h"
#include "firmware_app/chain/track_store.h"
#include "firmware_app/config/config.h"

namespace app {

class RunReport;

// The service's chain behind the tracker (firmware_app/chain), frame by frame in one loop: used by `replay` and by the
// simulations of the tools. Set-up throws ConfigError, std::invalid_argument.

// Samples of all channels -> SpectrumAccumulator -> ModeIdentification, with the same intermediate estimates as in the
// service, so that modes get the same history.
class ChannelAnalysis {
 public:
  // Channels without an image, witnesses (if any) last: the row delays that they state are corrected.
  ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels, double rate_hz);
  // As a run's channels are identified, with their corrections. The log outlives this.
  ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels, double rate_hz,
                  ModeIdentification::MakeIdentifier make_identifier, const CorrectionLog& book);

  // Before the first sample: takes over sums, modes and counts of an earlier record. One segment between is masked.
  void go_on_from(ChannelAnalysis& earlier);
  // The same with the state from which a run resumed (boot_id not empty: the stamps continue, too); counts begin at
  // zero. False: its spectra do not fit.
  [[nodiscard]] bool resume(const RunState& state) noexcept;
  void report_to(RunReport* report) noexcept { report_ = report; }  // called with every estimate; null = none

  // A state of the aircraft received before the next sample.
  void take(const core::AircraftState& state) noexcept { spectra_.take(state); }
  // Before the next sample: goes on as a run that was measured again.
  void take_over(Rebuild& rebuilt) noexcept {
    spectra_.take_over(rebuilt.spectra(), rebuilt.modes());
    rebuilt.note_spectra_taken();
  }
  // False: the frame has no cell of its own on the grid, and is left out.
  bool push(const core::DisplacementSample& sample);
  // Call once, after the last sample.
  [[nodiscard]] core::ModalEstimate finish();

  // The number of differences that the spectra require, as used by finish().
  [[nodiscard]] int n_differences() const {
    return config_.as_published ? 0 : core::choose_differences(spectra_.sums(), config_.max_frequency_hz);
  }
  // Identifies the same samples with another prewhitening (as in core::IdentifierConfig); no estimate of the run.
  [[nodiscard]] core::ModalEstimate identified(int n_differences) const;

  [[nodiscard]] const core::Health& losses() const noexcept { return losses_; }
  // Everything of the record that finish() used; the caller supplies `view`. Only for channels of a run.
  [[nodiscard]] SetupSums setup_sums() const;
  // Totals of the channels without witnesses, after finish().
  [[nodiscard]] const core::CpsdSums& sums() const noexcept { return result_.sums; }

 private:
  void identify_when_due();

  core::IdentifierConfig config_;
  std::vector<core::ChannelInfo> channels_;
  ModeIdentification modes_;
  SpectrumAccumulator spectra_;
  SpectrumSnapshot snapshot_;    // newest
  IdentificationResult result_;  // of it
  core::Health losses_;
  RunReport* report_ = nullptr;
};

// The same, starting from tracked points.
class TrackAnalysis {
 public:
  // keyframe: the first frame's tracks; contains every later point, all seen.
  TrackAnalysis(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe);
  TrackAnalysis(const TrackAnalysis&) = delete;
  TrackAnalysis& operator=(const TrackAnalysis&) = delete;

  // Takes an attitude received since the last (camera.attitude_channel); call before the frames to which it applies.
  void take(const core::AttitudeSample& sample) noexcept { meter_.take(sample); }
  void take(const core::AircraftState& state) noexcept { analysis_.take(state); }
  // Before the first frame: continues the spectra and modes of an earlier run of the same view.
  void go_on_from(TrackAnalysis& earlier) {
    if (diagnosis_) diagnosis_->forget_past();
    analysis_.go_on_from(earlier.analysis_);
  }
  [[nodiscard]] bool resume(const RunState& state) noexcept {
    if (diagnosis_) diagnosis_->forget_past();
    return analysis_.resume(state);
  }
  // `hear` receives each report of residual diagnosis; with closure.adopt: off there are none.
  void hear_closure(std::function<void(const core::closure::ClosureReport&)> hear) { hear_closure_ = std::move(hear); }
  // Ends the record: a last report, and the estimate.
  [[nodiscard]] core::ModalEstimate finish();
  // Points as in the keyframe and in its order; their inliers are marked. stride: as DisplacementSample::stride.
  // Returns false as ChannelAnalysis::push does.
  bool push(core::TrackFrame& tracks, std::uint32_t stride = 1);

  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept { return meter_.channels().channels(); }
  [[nodiscard]] const core::MotionAxes& axes() const noexcept { return meter_.axes(); }
  [[nodiscard]] const core::DisplacementSample& sample() const noexcept { return sample_; }  // of the last frame
  [[nodiscard]] ChannelAnalysis& analysis() noexcept { return analysis_; }
  [[nodiscard]] const CorrectionLog& corrections() const noexcept { return book_; }  // adopted so far

 private:
  void begin_frame(std::uint64_t sequence);
  void report(bool final);

  AppConfig config_;
  core::CameraInfo camera_;
  core::TrackFrame keyframe_;
  std::unique_ptr<Geometry> declared_;
  CorrectionLog book_;
  TrackLattice lattice_;
  DisplacementMeter meter_;
  std::optional<Diagnosis> diagnosis_;  // empty: not requested
  std::function<void(const core::closure::ClosureReport&)> hear_closure_;
  core::DisplacementSample sample_;
  ChannelAnalysis analysis_;
};

}  // namespace app
