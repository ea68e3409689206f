#pragma once

#include <cstdint>
#include <vector>

namespace core {

// One point of the structure in one frame. Pixel centres lie at integers; u right, v down, raw (distorted) image.
struct TrackPoint {
  double u_px = 0.0;
  double v_px = 0.0;
  double sigma_px = 0.0;  // standard deviation per axis
  std::uint32_t id = 0;   // unique over the run
  std::uint16_t region = 0;
  bool seen = false;    // a lost point has no sample, never a zero
  bool inlier = false;  // agrees with its region's motion (MLESAC)
};

// All points of one frame. `points` is sized once; the number of points is constant between re-seedings.
struct TrackFrame {
  std::uint64_t sequence = 0;
  std::int64_t t_start_ns = 0;
  bool gap_before = false;
  std::vector<TrackPoint> points;
};

}  // namespace core
