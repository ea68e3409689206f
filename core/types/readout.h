#pragma once

#include <optional>
#include <string>

namespace core {

// Signed readout time with its standard deviation, in frames (times the frame rate), from tracks.
struct ReadoutEstimate {
  bool observable = false;  // false: too little motion across the lines; all values below are then 0
  double frames = 0.0;
  double std_frames = 0.0;
  int n_degrees = 0;          // degrees of freedom of std_frames (Student's t)
  int n_bands = 0;            // frequency bands with informative motion ...
  int n_bands_against = 0;    // ... and those of them that are excluded, because they contradict the others
  double seconds_used = 0.0;  // length of the record used
};

// A readout time and its standard deviation.
struct ReadoutValue {
  double readout_s = 0.0;
  double std_s = 0.0;  // 0 = exact
};

// Readout times known to one estimate, and the one that it uses.
struct ReadoutFinding {
  ReadoutValue declared, used;
  std::optional<ReadoutValue> from_tracks, from_shapes;
  bool consistent = true;  // false: two of them differ by more than their standard deviations allow
  std::string why;         // description of the one used
};

}  // namespace core
