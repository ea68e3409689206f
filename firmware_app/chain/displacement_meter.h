#pragma once

#include <cstdint>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/motion_axes.h"
#include "core/geometry/readout_estimator.h"
#include "core/types/attitude.h"
#include "core/types/displacement.h"
#include "core/types/track.h"
#include "firmware_app/chain/items.h"
#include "firmware_app/chain/sample_offset.h"
#include "firmware_app/chain/track_store.h"

namespace app {

// Points of a frame -> displacement of every channel, with the readout time estimated from the points so far. The
// geometry changes at the frames that the diagnosis names. One thread; nothing allocates.
class DisplacementMeter {
 public:
  // As declared; all outlive this. lattice: points are rounded to it first; null: they are not.
  DisplacementMeter(core::ChannelDisplacement& channels, core::ReadoutEstimator& readout,
                    const TrackLattice* lattice = nullptr)
      : channels_(&channels), readout_(&readout), lattice_(lattice), axes_(channels.regions(), channels.n_points()) {}

  // Takes an attitude received since the last frame.
  void take(const core::AttitudeSample& sample) noexcept { channels_->take(sample); }
  // Takes the changes in the order of the diagnosis' reports.
  void take(const CorrectionSwitch& change) noexcept {
    if (change.geometry != nullptr) pending_ = change;
  }
  // Call before each frame. True: a correction begins with it.
  [[nodiscard]] bool begin_frame(std::uint64_t sequence) noexcept;
  // Marks the inliers among the points. stride: one of so many frames of the source is kept.
  void measure(core::TrackFrame& tracks, std::uint32_t stride, core::DisplacementSample& out) noexcept;

  // From the next frame on subtracted from every sample.
  void set_offset(const SampleOffset& offset) { offset_ = offset; }

  [[nodiscard]] std::uint32_t correction_set() const noexcept { return correction_set_; }  // in force
  [[nodiscard]] Rebuild* rebuilt() const noexcept { return rebuilt_; }                     // of it; null: none
  [[nodiscard]] Rebuild* coming() const noexcept { return pending_.rebuilt; }              // not in force yet
  [[nodiscard]] const core::ChannelDisplacement& channels() const noexcept { return *channels_; }
  // In which direction the regions have moved so far, whatever their axes.
  [[nodiscard]] const core::MotionAxes& axes() const noexcept { return axes_; }

 private:
  core::ChannelDisplacement* channels_;
  core::ReadoutEstimator* readout_;
  const TrackLattice* lattice_;
  core::MotionAxes axes_;
  CorrectionSwitch pending_;  // geometry null: none
  SampleOffset offset_;
  Rebuild* rebuilt_ = nullptr;
  std::uint32_t correction_set_ = 0, record_ = 0;
};

}  // namespace app
