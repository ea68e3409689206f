#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "core/types/region.h"

namespace core {

struct SeedConfig {
  int points_per_region = 30;
  double min_distance_px = 8.0;
  double corner_quality = 0.01;  // Harris response relative to the region's strongest corner
  int window_px = 21;            // tracking window: a point keeps half of it clear of the image border
};

// Harris corners (Harris & Stephens 1988) inside the region's rectangle, strongest first. gray: 8-bit. Empty if the
// rectangle has no texture.
[[nodiscard]] std::vector<cv::Point2f> seed_points(const cv::Mat& gray, const Region& region, const SeedConfig& config);

}  // namespace core
