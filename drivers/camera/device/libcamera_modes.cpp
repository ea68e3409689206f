#include "drivers/camera/device/libcamera_modes.h"

#include <algorithm>
#include <array>
#include <vector>

namespace drivers {

namespace lc = libcamera;

namespace {

constexpr unsigned kLargestWidth_px = 1920, kLargestHeight_px = 1080;

struct Readable {
  lc::PixelFormat format;
  PixelLayout layout;
};
// In order of increasing cost. libcamera names RGB formats by the register, least significant byte last.
const std::array kReadable = {
    Readable{lc::formats::R8, PixelLayout::kGray8},     Readable{lc::formats::NV12, PixelLayout::kGray8},
    Readable{lc::formats::NV21, PixelLayout::kGray8},   Readable{lc::formats::YUV420, PixelLayout::kGray8},
    Readable{lc::formats::YVU420, PixelLayout::kGray8}, Readable{lc::formats::YUYV, PixelLayout::kYuyv},
    Readable{lc::formats::YVYU, PixelLayout::kYuyv},    Readable{lc::formats::UYVY, PixelLayout::kUyvy},
    Readable{lc::formats::VYUY, PixelLayout::kUyvy},    Readable{lc::formats::R10, PixelLayout::kGray10},
    Readable{lc::formats::RGB888, PixelLayout::kBgr24}, Readable{lc::formats::BGR888, PixelLayout::kRgb24},
    Readable{lc::formats::MJPEG, PixelLayout::kMjpeg},
};

lc::Size largest_size(const lc::StreamConfiguration& stream, const lc::PixelFormat& format) {
  lc::Size largest;
  for (const lc::Size& size : stream.formats().sizes(format)) {
    if (size.width <= kLargestWidth_px && size.height <= kLargestHeight_px && size > largest) largest = size;
  }
  return largest.isNull() ? stream.size : largest;
}

}  // namespace

std::optional<LibcameraMode> choose_mode(const lc::StreamConfiguration& stream, lc::Size wanted) {
  const std::vector<lc::PixelFormat> offered = stream.formats().pixelformats();
  for (const Readable& readable : kReadable) {
    if (std::find(offered.begin(), offered.end(), readable.format) == offered.end()) continue;
    return LibcameraMode{readable.format, readable.layout,
                         wanted.isNull() ? largest_size(stream, readable.format) : wanted};
  }
  return std::nullopt;
}

}  // namespace drivers
