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
  int cost;  // formats of one cost differ in the order of their components
};
// libcamera names RGB formats by the register, least significant byte last.
const std::array kReadable = {
    Readable{lc::formats::R8, PixelLayout::kGray8, 0},     Readable{lc::formats::NV12, PixelLayout::kGray8, 1},
    Readable{lc::formats::NV21, PixelLayout::kGray8, 1},   Readable{lc::formats::YUV420, PixelLayout::kGray8, 2},
    Readable{lc::formats::YVU420, PixelLayout::kGray8, 2}, Readable{lc::formats::YUYV, PixelLayout::kYuyv, 3},
    Readable{lc::formats::YVYU, PixelLayout::kYuyv, 3},    Readable{lc::formats::UYVY, PixelLayout::kUyvy, 3},
    Readable{lc::formats::VYUY, PixelLayout::kUyvy, 3},    Readable{lc::formats::R10, PixelLayout::kGray10, 4},
    Readable{lc::formats::RGB888, PixelLayout::kBgr24, 5}, Readable{lc::formats::BGR888, PixelLayout::kRgb24, 5},
    Readable{lc::formats::MJPEG, PixelLayout::kMjpeg, 6},
};

lc::Size largest_size(const lc::StreamConfiguration& stream, const lc::PixelFormat& format) {
  lc::Size largest;
  for (const lc::Size& size : stream.formats().sizes(format)) {
    if (size.width <= kLargestWidth_px && size.height <= kLargestHeight_px && size > largest) largest = size;
  }
  return largest.isNull() ? stream.size : largest;
}

}  // namespace

// A pipeline may offer formats that it cannot stream: vimc of Linux 6.12 RGB888. Its own choice is the best tried one.
std::optional<LibcameraMode> choose_mode(const lc::StreamConfiguration& stream, lc::Size wanted) {
  const std::vector<lc::PixelFormat> offered = stream.formats().pixelformats();
  const Readable* best = nullptr;
  for (const Readable& one : kReadable) {
    if (std::find(offered.begin(), offered.end(), one.format) == offered.end()) continue;
    const bool is_cheaper = best == nullptr || one.cost < best->cost;
    const bool is_its_own = best != nullptr && one.cost == best->cost && one.format == stream.pixelFormat;
    if (is_cheaper || is_its_own) best = &one;
  }
  if (best == nullptr) return std::nullopt;
  return LibcameraMode{best->format, best->layout, wanted.isNull() ? largest_size(stream, best->format) : wanted};
}

}  // namespace drivers
