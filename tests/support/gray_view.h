#pragma once

#include <opencv2/core.hpp>

#include "core/types/gray_view.h"

namespace test_support {

// Points into the image, which must outlive it. Empty unless the image is 8-bit grey.
inline core::GrayView view(const cv::Mat& image) {
  if (image.empty() || image.type() != CV_8UC1) return {};
  return {image.data, image.cols, image.rows, image.step[0]};
}

}  // namespace test_support
