#include "drivers/camera/recording/gray_convert.h"

#include <cstring>

#include <opencv2/imgproc.hpp>

namespace drivers {

const char* to_string(GrayStatus status) noexcept {
  switch (status) {
    case GrayStatus::kOk:
      return "ok";
    case GrayStatus::kEmpty:
      return "image without pixels";
    case GrayStatus::kNot8Bit:
      return "image is not 8 bits per channel";
    case GrayStatus::kChannelCount:
      return "image has neither 1, 3 nor 4 channels";
    case GrayStatus::kSizeMismatch:
      return "image is not of the size the stream began with";
    case GrayStatus::kConversionFailed:
      return "conversion to gray failed";
  }
  return "unknown";
}

namespace {

void copy_rows(const cv::Mat& gray, std::uint8_t* pixels) noexcept {
  const auto row_bytes = static_cast<std::size_t>(gray.cols);
  if (gray.isContinuous()) {
    std::memcpy(pixels, gray.data, row_bytes * static_cast<std::size_t>(gray.rows));
    return;
  }
  for (int row = 0; row < gray.rows; ++row) {
    std::memcpy(pixels + row_bytes * static_cast<std::size_t>(row), gray.ptr(row), row_bytes);
  }
}

}  // namespace

GrayStatus convert_to_gray(const cv::Mat& image, core::Frame& out) noexcept {
  if (image.empty() || image.dims != 2) return GrayStatus::kEmpty;
  if (image.depth() != CV_8U) return GrayStatus::kNot8Bit;
  const int n_channels = image.channels();
  if (n_channels != 1 && n_channels != 3 && n_channels != 4) return GrayStatus::kChannelCount;
  if (out.pixels.size() != image.total()) return GrayStatus::kSizeMismatch;
  out.width_px = image.cols;
  out.height_px = image.rows;
  if (n_channels == 1) {
    copy_rows(image, out.pixels.data());
    return GrayStatus::kOk;
  }
  try {
    // A destination of the right size and type is written in place: cvtColor does not allocate.
    cv::Mat gray(image.rows, image.cols, CV_8UC1, out.pixels.data());
    cv::cvtColor(image, gray, n_channels == 3 ? cv::COLOR_BGR2GRAY : cv::COLOR_BGRA2GRAY);
    return gray.data == out.pixels.data() ? GrayStatus::kOk : GrayStatus::kConversionFailed;
  } catch (...) {
    return GrayStatus::kConversionFailed;
  }
}

}  // namespace drivers
