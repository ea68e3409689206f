#include "drivers/telemetry/preview_jpeg.h"

#include <stdexcept>

#include "drivers/images/image_encoder.h"

namespace drivers {

std::vector<std::uint8_t> preview_jpeg(const core::Preview& preview) {
  const auto n_pixels = static_cast<std::size_t>(preview.width_px) * static_cast<std::size_t>(preview.height_px);
  if (preview.width_px < 1 || preview.height_px < 1 || preview.pixels.size() != n_pixels) {
    throw std::runtime_error("preview: the number of pixels is not width x height");
  }
  // OpenCV requires non-const data, but only reads.
  const cv::Mat image(preview.height_px, preview.width_px, CV_8UC1, const_cast<std::uint8_t*>(preview.pixels.data()));
  std::vector<std::uint8_t> bytes;
  for (const int quality : {50, 30, 15, 5}) {
    bytes = encode_jpeg(image, quality, true);
    if (bytes.size() <= kPreviewJpegBytes) break;
  }
  return bytes;
}

}  // namespace drivers
