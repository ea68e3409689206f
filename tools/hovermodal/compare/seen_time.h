#pragma once

#include <string>

namespace tools {

// When a channel is seen, beyond the row delay of its keyframe: a sample is the mean over the exposure, and a region
// that is elsewhere in the image than in the keyframe is read at another time.
struct SeenTime {
  double half_exposure_s = 0.0;
  double mean_row_shift_s = 0.0;  // over the points and frames of the run, relative to each point's first frame
};

// From the tracks.csv of the run's folder; zeros without one. Throws drivers::FileError naming the line.
[[nodiscard]] SeenTime seen_time(const std::string& run, const std::string& channel);

}  // namespace tools
