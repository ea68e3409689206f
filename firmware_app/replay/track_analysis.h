#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/identification/identifier.h"
#include "core/identification/prewhitening.h"
#include "core/types/attitude.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/track.h"
#include "firmware_app/chain/diagnosis.h"
#include "firmware_app/chain/displacement_meter.h"
#include "firmware_app/chain/mode_identification.h"
#include "firmware_app/chain/spectrum_accumulator.h"
#include "firmware_app/chain/state/setup_sums.h"
#include "firmware_app/config/config.h"

namespace app {

class RunReport;

// The service's chain behind the tracker (firmware_app/chain), frame by frame in one loop: what `replay` and the tools'
// own simulations run. Set-up throws ConfigError, std::invalid_argument.

// Samples of all channels -> SpectrumAccumulator -> ModeIdentification, with the estimates on the way that the service
// makes, so that modes get the same history.
class ChannelAnalysis {
 public:
  // Channels without an image, their witnesses, if any, last: row delays are undone as these state them.
  ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels, double rate_hz);
  // As a run's channels are identified, with what is taken out of them. The book outlives this.
  ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels, double rate_hz,
                  ModeIdentification::MakeIdentifier make_identifier, const CorrectionLog& book);

  // Before the first sample: the sums, modes and counts of an earlier record. One segment lies between.
  void go_on_from(ChannelAnalysis& earlier);
  // The same with the state that a run went on with (its boot_id not empty: stamps go on, too), whose counts begin
  // anew. False: its spectra do not fit.
  [[nodiscard]] bool resume(const RunState& state) noexcept;
  void report_to(RunReport* report) noexcept { report_ = report; }  // every estimate; null = none

  // False: a frame that lies in no cell of its own of the grid, and is left out.
  bool push(const core::DisplacementSample& sample);
  // Once, after the last sample.
  [[nodiscard]] core::ModalEstimate finish();

  // The prewhitening that the spectra ask for, and that finish() used.
  [[nodiscard]] int n_differences() const {
    return config_.as_published ? 0 : core::choose_differences(spectra_.sums(), config_.max_frequency_hz);
  }
  // Those samples again with another prewhitening (as core::IdentifierConfig takes it); no estimate of the run.
  [[nodiscard]] core::ModalEstimate identified(int n_differences) const;

  [[nodiscard]] const core::Health& losses() const noexcept { return losses_; }
  // All that finish() used of the record; `view` is the caller's. Of a run's channels only.
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

// The same from tracked points on.
class TrackAnalysis {
 public:
  // keyframe: the first frame's tracks; every point that will come, seen.
  TrackAnalysis(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe);
  TrackAnalysis(const TrackAnalysis&) = delete;
  TrackAnalysis& operator=(const TrackAnalysis&) = delete;

  // An attitude that came since (camera.attitude_channel), before the frames it tells of.
  void take(const core::AttitudeSample& sample) noexcept { meter_.take(sample); }
  // Before the first frame: the spectra and modes of an earlier run of the same view are gone on with.
  void go_on_from(TrackAnalysis& earlier) { analysis_.go_on_from(earlier.analysis_); }
  [[nodiscard]] bool resume(const RunState& state) noexcept { return analysis_.resume(state); }
  // Told each report of closing the loop; with closure.adopt: off there is none.
  void hear_closure(std::function<void(const core::closure::ClosureReport&)> hear) { hear_closure_ = std::move(hear); }
  // The end of the record: a last report, and the estimate.
  [[nodiscard]] core::ModalEstimate finish();
  // Points as in the keyframe, in its order; their inliers are marked. stride: as DisplacementSample::stride. False as
  // ChannelAnalysis::push.
  bool push(core::TrackFrame& tracks, std::uint32_t stride = 1);

  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept { return meter_.channels().channels(); }
  [[nodiscard]] const core::MotionAxes& axes() const noexcept { return meter_.axes(); }
  [[nodiscard]] const core::DisplacementSample& sample() const noexcept { return sample_; }  // of the last frame
  [[nodiscard]] ChannelAnalysis& analysis() noexcept { return analysis_; }

 private:
  void report(bool final);

  AppConfig config_;
  core::CameraInfo camera_;
  core::TrackFrame keyframe_;
  std::unique_ptr<Geometry> declared_;
  CorrectionLog book_;
  DisplacementMeter meter_;
  std::optional<Diagnosis> diagnosis_;  // empty: nobody wants it
  std::function<void(const core::closure::ClosureReport&)> hear_closure_;
  core::DisplacementSample sample_;
  ChannelAnalysis analysis_;
};

}  // namespace app
