#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/channel_displacement.h"
#include "core/geometry/place_correction.h"
#include "core/geometry/readout_estimator.h"
#include "core/types/frame.h"
#include "core/types/track.h"
#include "firmware_app/config.h"

namespace app {

// What a run has learned of its own camera and tracker, and takes out from a frame on. Number 0: as declared.
struct Amendment {
  std::uint32_t number = 0;
  std::uint64_t from_sequence = 0;
  bool begins_record = false;  // rows are seen at other times than before: spectra of both are not to be added
  std::uint32_t record = 0;    // number of the amendment since which they may be
  core::PlaceCorrection places;
  double added_readout_frames = 0.0, readout_sigma_frames = 0.0;  // 0, 0: as declared
  std::vector<std::string> words;                                 // all effects in force

  [[nodiscard]] AppConfig applied(const AppConfig& config, double rate_hz) const;
  [[nodiscard]] core::CameraInfo applied(const core::CameraInfo& camera) const;
};

// What measures the frames of a run under an amendment.
struct Geometry {
  core::ChannelDisplacement displacement;
  core::ReadoutEstimator readout;
};
// Throws as displacement_config().
[[nodiscard]] std::unique_ptr<Geometry> make_geometry(const AppConfig& config, const core::CameraInfo& camera,
                                                      const core::TrackFrame& keyframe, const Amendment& amendment);

// All amendments of a run. One thread adds; any reads one whose number has reached it through a ring: nothing that is
// in the book ever changes.
class AmendmentBook {
 public:
  static constexpr std::size_t kMost = 64;  // the declared state is the first
  [[nodiscard]] bool full() const noexcept { return n_ == kMost; }
  // Gives it its number and record.
  const Amendment& add(Amendment amendment) {
    amendment.number = static_cast<std::uint32_t>(n_);
    amendment.record = amendment.begins_record ? amendment.number : pages_[n_ - 1].record;
    return pages_[n_++] = std::move(amendment);
  }
  [[nodiscard]] const Amendment& at(std::uint32_t number) const { return pages_.at(number); }
  [[nodiscard]] const Amendment& newest() const noexcept { return pages_[n_ - 1]; }  // the thread that adds

 private:
  std::array<Amendment, kMost> pages_{};
  std::size_t n_ = 1;
};

}  // namespace app
