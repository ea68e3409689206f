#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace drivers {

// Images as files in memory, by libjpeg and libpng directly: OpenCV's imgcodecs would link GDAL and a hundred other
// libraries. The bytes are those of cv::imencode with the same settings. Both throw std::runtime_error with the
// library's message: a side above its limit (65500 px for JPEG), out of memory.

// `gray`: CV_8UC1. `quality`: 1 ... 100. `optimize`: Huffman tables for this image, smaller and slower.
[[nodiscard]] std::vector<std::uint8_t> encode_jpeg(const cv::Mat& gray, int quality, bool optimize = false);

// `bgr`: CV_8UC3, blue first. `level`: of zlib, 0 ... 9.
[[nodiscard]] std::vector<std::uint8_t> encode_png(const cv::Mat& bgr, int level);

}  // namespace drivers
