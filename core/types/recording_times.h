#pragma once

#include <cstdint>
#include <string>

#include "core/types/frame_prediction.h"

namespace core {

// Regularity of a recording's frame times, and its losses. All zero and empty: not a recording.
struct RecordingTimes {
  std::string from;            // source of the times, e.g. "the container's times"; empty: not a recording
  double rate_hz = 0.0;        // of the grid to which frames are assigned
  double stated_hz = 0.0;      // frame rate that the container states; 0 = none
  double jitter_s = 0.0;       // rms deviation of the frames' times from the grid
  double worst_s = 0.0;        // largest such deviation
  std::uint64_t n_frames = 0;  // in the file, as far as it was scanned
  std::uint64_t n_lost = 0;    // cells of the grid without a frame in the file, between its first and last frame
  std::uint64_t n_gaps = 0;    // number of contiguous groups of such cells
  double longest_gap_s = 0.0;
  std::uint64_t n_repeated = 0;      // so far: frames that repeat the previous picture; omitted
  std::uint64_t n_damaged = 0;       // so far: frames that were not decoded completely; omitted
  std::uint64_t n_after_damage = 0;  // so far: frames predicted from a damaged one; used
  std::string remark;                // description of inconsistencies; empty: none
  FramePrediction prediction = FramePrediction::kUnknown;

  bool operator==(const RecordingTimes&) const = default;
  [[nodiscard]] bool known() const noexcept { return !from.empty(); }
};

}  // namespace core
