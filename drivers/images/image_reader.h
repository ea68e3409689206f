#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace drivers {

// cv::imread(path, flags); empty if the file cannot be decoded. OpenCV's imgcodecs is loaded with the first image,
// not at program start: it brings GDAL and a hundred other libraries, which most runs never need (a clip is decoded by
// libavcodec). Throws std::runtime_error if it is not installed, and where the image has more than
// Limits::kImagePixels, before they are decoded. Any thread.
[[nodiscard]] cv::Mat read_image(const std::string& path, int flags);

}  // namespace drivers
