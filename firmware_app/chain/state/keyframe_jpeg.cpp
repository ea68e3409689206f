#include "firmware_app/chain/state/keyframe_jpeg.h"

#include <vector>

#include "drivers/camera/device/luma.h"
#include "drivers/images/image_encoder.h"

namespace app {
namespace {

constexpr int kQuality = 85;
constexpr std::size_t kMostPixels = std::size_t{1} << 28;  // the size stated in a record is not trusted

}  // namespace

std::string keyframe_jpeg(const core::Frame& image) {
  const auto n_pixels = static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px);
  if (n_pixels == 0 || image.pixels.size() < n_pixels) return {};
  // cv::Mat borrows the pixels; they are only read.
  const cv::Mat gray(image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.pixels.data()));
  const std::vector<std::uint8_t> bytes = drivers::encode_jpeg(gray, kQuality);
  return {bytes.begin(), bytes.end()};
}

std::optional<core::Frame> keyframe_of(const std::string& jpeg, const core::CameraInfo& camera) {
  if (jpeg.empty() || camera.width_px < 1 || camera.height_px < 1) return std::nullopt;
  const auto n_pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
  if (n_pixels > kMostPixels) return std::nullopt;
  const std::vector<std::uint8_t> bytes(jpeg.begin(), jpeg.end());
  core::Frame out;
  out.width_px = camera.width_px, out.height_px = camera.height_px;
  out.pixels.resize(n_pixels);
  drivers::LumaReader reader(drivers::PixelLayout::kMjpeg, camera.width_px, camera.height_px, 0);
  if (reader.read(bytes.data(), bytes.size(), out.pixels.data()) != drivers::LumaStatus::kOk) return std::nullopt;
  return out;
}

}  // namespace app
