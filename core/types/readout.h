#pragma once

#include <optional>

namespace core {

// Signed readout time with its standard deviation, in frames (times the frame rate).
struct ReadoutEstimate {
  bool observable = false;  // false: nothing moves enough across the lines; the numbers below are then 0
  double frames = 0.0;
  double std_frames = 0.0;
  int n_degrees = 0;          // of freedom behind std_frames (Student's t)
  int n_bands = 0;            // frequency bands with motion that tells ...
  int n_bands_against = 0;    // ... and those of them left out, because they contradict the others
  double seconds_used = 0.0;  // of record
};

}  // namespace core
