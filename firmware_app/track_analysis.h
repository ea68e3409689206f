#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/identification/identifier.h"
#include "core/identification/mode_tracker.h"
#include "core/identification/prewhitening.h"
#include "core/spectrum/time_grid.h"
#include "core/spectrum/welch_cpsd.h"
#include "core/types/displacement.h"
#include "core/types/health.h"
#include "core/types/modal_estimate.h"
#include "core/types/track.h"
#include "firmware_app/amendment.h"
#include "firmware_app/config.h"
#include "firmware_app/loop_closer.h"
#include "firmware_app/readout_use.h"
#include "firmware_app/view_sums.h"

namespace app {

class RunReport;

// The service's chain behind the tracker, frame by frame in one thread: what `replay` and the tools' own simulations
// run. Set-up throws ConfigError, std::invalid_argument.

// Samples of all channels -> grid of the frames -> spectra -> modes, with the estimates on the way that the service
// makes, so that modes get the same history.
class ChannelAnalysis {
 public:
  // channels: of the samples; their witnesses, if any, last.
  ChannelAnalysis(const AppConfig& config, const std::vector<core::ChannelInfo>& channels, double rate_hz);

  // Find the readout time on the way; else row delays are undone as declared.
  void find_readout(ReadoutUse use) { readout_use_.emplace(std::move(use)); }
  // From the next sample on something else is taken out of the points: one segment is masked, or, where a new record
  // begins, an estimate of what came so far is made, and new sums begin.
  void amend(ReadoutUse use, const Amendment& amendment);
  // Before the first sample: the sums, modes and counts of an earlier record. One segment lies between.
  void go_on_from(ChannelAnalysis& earlier);
  void report_to(RunReport* report) noexcept { report_ = report; }  // every estimate; null = none

  // False: a frame that lies in no cell of its own of the grid, and is left out.
  bool push(const core::DisplacementSample& sample);
  // Once, after the last sample.
  [[nodiscard]] core::ModalEstimate finish();

  // The prewhitening that the spectra ask for, and that finish() used.
  [[nodiscard]] int n_differences() const {
    return config_.as_published ? 0 : core::choose_differences(cpsd_.sums(), config_.max_frequency_hz);
  }
  // Those samples again with another prewhitening (as core::IdentifierConfig takes it); no estimate of the run.
  [[nodiscard]] core::ModalEstimate identified(int n_differences) const;

  [[nodiscard]] const core::Health& losses() const noexcept { return losses_; }
  // All that finish() used of the record; `view` is the caller's. With find_readout() only.
  [[nodiscard]] ViewSums view_sums() const;
  // Totals of the channels without witnesses, after finish().
  [[nodiscard]] const core::CpsdSums& sums() const noexcept { return totals_; }

 private:
  void note(bool hop);
  [[nodiscard]] core::ModalEstimate make();

  core::IdentifierConfig config_;
  core::Identifier identifier_;
  std::optional<ReadoutUse> readout_use_;
  core::ReadoutEstimate readout_;        // with the last sample
  std::vector<std::string> amendments_;  // in force
  core::ModeTracker tracker_;
  core::WelchCpsd cpsd_;
  core::CpsdSums totals_;
  core::TimeGrid grid_;
  core::Health losses_;
  double rate_hz_;
  std::uint64_t n_masked_before_ = 0;  // in sums that were ended
  std::uint64_t period_hops_, n_estimates_ = 0;
  RunReport* report_ = nullptr;
};

// The same from tracked points on.
class TrackAnalysis {
 public:
  // keyframe: the first frame's tracks; every point that will come, seen.
  TrackAnalysis(const AppConfig& config, const core::CameraInfo& camera, const core::TrackFrame& keyframe);

  // An attitude that came since (camera.attitude_channel), before the frames it tells of.
  void take(const core::AttitudeSample& sample) noexcept { geometry_->displacement.take(sample); }
  // Before the first frame: the spectra and modes of an earlier run of the same view are gone on with.
  void go_on_from(TrackAnalysis& earlier);
  // Told each report of closing the loop; without, and with closure.adopt other than `auto`, nobody looks.
  void hear_closure(std::function<void(const core::closure::ClosureReport&)> hear) { hear_closure_ = std::move(hear); }
  // The end of the record: a last report, and the estimate.
  [[nodiscard]] core::ModalEstimate finish();
  // Points as in the keyframe, in its order; their inliers are marked. False as ChannelAnalysis::push.
  bool push(core::TrackFrame& tracks);

  [[nodiscard]] const std::vector<core::ChannelInfo>& channels() const noexcept {
    return geometry_->displacement.channels();
  }
  [[nodiscard]] const core::DisplacementSample& sample() const noexcept { return sample_; }  // of the last frame
  [[nodiscard]] ChannelAnalysis& analysis() noexcept { return analysis_; }

 private:
  void close_loop(const core::TrackFrame& tracks);
  void begin_amendment(std::uint64_t sequence);

  AppConfig config_;
  core::CameraInfo camera_;
  core::TrackFrame keyframe_;
  std::unique_ptr<Geometry> geometry_;
  std::optional<LoopCloser> loop_;
  std::optional<Amendment> pending_;
  AmendmentBook book_;
  std::function<void(const core::closure::ClosureReport&)> hear_closure_;
  core::DisplacementSample sample_;
  ChannelAnalysis analysis_;
};

}  // namespace app
