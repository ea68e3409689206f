#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/point_correction.h"
#include "core/geometry/readout_estimator.h"
#include "core/types/frame.h"
#include "core/types/track.h"
#include "firmware_app/config/config.h"

namespace app {

// Corrections of the run's own camera and tracker, in force from one frame on. Number 0: only what was declared.
struct CorrectionSet {
  std::uint32_t number = 0;
  std::uint64_t from_sequence = 0;   // first frame that is measured so as it comes
  std::uint64_t since_sequence = 0;  // first frame that is so where the run is measured again
  bool begins_record = false;  // rows are seen at other times than before: spectra from both sides must not be added
  std::uint32_t record = 0;    // epoch: number of the correction_set since which spectra may be added
  core::PointCorrection places;
  double added_readout_frames = 0.0, readout_sigma_frames = 0.0;  // 0, 0: as declared
  std::vector<std::string> words;                                 // all effects in force

  [[nodiscard]] AppConfig applied(const AppConfig& config, double rate_hz) const;
  [[nodiscard]] core::CameraInfo applied(const core::CameraInfo& camera) const;
};

// The measurement of a run's frames under one correction_set.
struct Geometry {
  core::ChannelDisplacement displacement;
  core::ReadoutEstimator readout;
};
// Throws as displacement_config().
[[nodiscard]] std::unique_ptr<Geometry> make_geometry(const AppConfig& config, const core::CameraInfo& camera,
                                                      const core::TrackFrame& keyframe,
                                                      const CorrectionSet& correction_set);

// All correction sets of a run. One thread adds; any thread reads a set whose number has reached it through a ring:
// entries of the log never change.
class CorrectionLog {
 public:
  static constexpr std::size_t kMost = 64;  // the declared state is the first
  [[nodiscard]] bool full() const noexcept { return n_ == kMost; }
  // Assigns number and record.
  const CorrectionSet& add(CorrectionSet correction_set) {
    correction_set.number = static_cast<std::uint32_t>(n_);
    correction_set.record = correction_set.begins_record ? correction_set.number : pages_[n_ - 1].record;
    return pages_[n_++] = std::move(correction_set);
  }
  [[nodiscard]] const CorrectionSet& at(std::uint32_t number) const { return pages_.at(number); }
  [[nodiscard]] const CorrectionSet& newest() const noexcept { return pages_[n_ - 1]; }  // the adding thread only

 private:
  std::array<CorrectionSet, kMost> pages_{};
  std::size_t n_ = 1;
};

}  // namespace app
