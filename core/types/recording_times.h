#pragma once

#include <cstdint>
#include <string>

namespace core {

// How evenly the frames of a recording lie in time, and what it lacks. All zero and empty: not a recording.
struct RecordingTimes {
  std::string from;            // where the times come from, e.g. "the container's times"; empty: not a recording
  double rate_hz = 0.0;        // of the grid that the frames are put on
  double stated_hz = 0.0;      // frame rate that the container states; 0 = none
  double jitter_s = 0.0;       // rms distance of the frames' times from the grid
  double worst_s = 0.0;        // largest such distance
  std::uint64_t n_frames = 0;  // in the file, as far as it was looked through
  std::uint64_t n_lost = 0;    // places of the grid without a frame in the file, between its first and last
  std::uint64_t n_gaps = 0;    // runs of such places
  double longest_gap_s = 0.0;
  std::uint64_t n_repeated = 0;      // so far: frames that show the picture before them once more; left out
  std::uint64_t n_damaged = 0;       // so far: frames that did not decode whole; left out
  std::uint64_t n_after_damage = 0;  // so far: frames predicted from a damaged one; used
  std::string remark;                // what does not fit together, in words; empty: nothing

  bool operator==(const RecordingTimes&) const = default;
  [[nodiscard]] bool known() const noexcept { return !from.empty(); }
};

}  // namespace core
