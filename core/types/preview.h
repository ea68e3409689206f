#pragma once

#include <cstdint>
#include <vector>

#include "core/types/track.h"

namespace core {

// Present position of a region relative to its declared one: mean shift of its inlier points since the keyframe.
struct RegionShift {
  double u_px = 0.0, v_px = 0.0;
  std::uint32_t n_points = 0;  // points in the mean; 0: unknown, both shifts are 0
};

// One reduced gray frame for display, with its tracks. Sized once.
struct Preview {
  std::uint64_t sequence = 0;
  std::int64_t t_start_ns = 0;
  int width_px = 0, height_px = 0;  // of the preview
  int reduction = 1;                // pixels of the image along a side of a preview pixel
  int image_width_px = 0, image_height_px = 0;
  std::vector<std::uint8_t> pixels;  // height x width, row-major
  std::vector<TrackPoint> points;    // in pixels of the image
  std::vector<RegionShift> shifts;   // of each region
};

}  // namespace core
