#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace drivers {

// cv::imread(path, flags); empty where the file cannot be decoded. OpenCV's imgcodecs is loaded with the first image,
// not with the program: it brings GDAL and a hundred other libraries, which most runs never need (a clip is decoded by
// libavcodec). Throws std::runtime_error where it is not installed. Any thread.
[[nodiscard]] cv::Mat read_image(const std::string& path, int flags);

}  // namespace drivers
