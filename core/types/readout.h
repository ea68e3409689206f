#pragma once

#include <optional>
#include <string>

namespace core {

// Signed readout time with its standard deviation, in frames (times the frame rate), from tracks.
struct ReadoutEstimate {
  bool observable = false;  // false: nothing moves enough across the lines; the numbers below are then 0
  double frames = 0.0;
  double std_frames = 0.0;
  int n_degrees = 0;          // of freedom behind std_frames (Student's t)
  int n_bands = 0;            // frequency bands with informative motion ...
  int n_bands_against = 0;    // ... and those of them left out, because they contradict the others
  double seconds_used = 0.0;  // of record
};

// A readout time and its standard deviation.
struct ReadoutValue {
  double readout_s = 0.0;
  double std_s = 0.0;  // 0 = exact
};

// Readout times known to one estimate, and the one it used.
struct ReadoutFinding {
  ReadoutValue declared, used;
  std::optional<ReadoutValue> from_tracks, from_shapes;
  bool consistent = true;  // false: two of them lie further apart than their deviations allow
  std::string why;         // the one used, in words
};

}  // namespace core
