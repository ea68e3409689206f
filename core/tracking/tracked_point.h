#pragma once

#include <opencv2/core.hpp>

namespace core {

struct TrackedPoint {
  cv::Point2f position;   // in the current image
  double sigma_px = 0.0;  // standard deviation per axis, from the residual and the texture (ARCHITECTURE.md)
  bool seen = false;
};

}  // namespace core
