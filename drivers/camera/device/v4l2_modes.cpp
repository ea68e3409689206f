#include "drivers/camera/device/v4l2_modes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <tuple>

namespace drivers {

namespace {

struct Readable {
  std::uint32_t fourcc;
  PixelLayout layout;
};
// In order of increasing cost; the planar formats begin with a luma plane, those whose name ends in M in a plane of its
// own.
constexpr std::array kReadable = {
    Readable{V4L2_PIX_FMT_GREY, PixelLayout::kGray8},    Readable{V4L2_PIX_FMT_NV12, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_NV12M, PixelLayout::kGray8},   Readable{V4L2_PIX_FMT_NV21, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_NV21M, PixelLayout::kGray8},   Readable{V4L2_PIX_FMT_YUV420, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_YUV420M, PixelLayout::kGray8}, Readable{V4L2_PIX_FMT_YVU420, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_YVU420M, PixelLayout::kGray8}, Readable{V4L2_PIX_FMT_YUV422P, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_YUV422M, PixelLayout::kGray8}, Readable{V4L2_PIX_FMT_YVU422M, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_NV16, PixelLayout::kGray8},    Readable{V4L2_PIX_FMT_NV16M, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_NV61, PixelLayout::kGray8},    Readable{V4L2_PIX_FMT_NV61M, PixelLayout::kGray8},
    Readable{V4L2_PIX_FMT_YUYV, PixelLayout::kYuyv},     Readable{V4L2_PIX_FMT_YVYU, PixelLayout::kYuyv},
    Readable{V4L2_PIX_FMT_UYVY, PixelLayout::kUyvy},     Readable{V4L2_PIX_FMT_VYUY, PixelLayout::kUyvy},
    Readable{V4L2_PIX_FMT_Y10, PixelLayout::kGray10},    Readable{V4L2_PIX_FMT_Y12, PixelLayout::kGray12},
    Readable{V4L2_PIX_FMT_Y16, PixelLayout::kGray16},    Readable{V4L2_PIX_FMT_BGR24, PixelLayout::kBgr24},
    Readable{V4L2_PIX_FMT_RGB24, PixelLayout::kRgb24},   Readable{V4L2_PIX_FMT_MJPEG, PixelLayout::kMjpeg},
    Readable{V4L2_PIX_FMT_JPEG, PixelLayout::kMjpeg},
};
struct Size {
  int width_px;
  int height_px;
};
constexpr std::array kCommonSizes = {Size{640, 480}, Size{1280, 720}, Size{1920, 1080}};
constexpr int kLargestWidth_px = 1920, kLargestHeight_px = 1080;  // larger sizes only on request
constexpr double kUsableRate_hz = 25.0;                           // sufficient for modes up to 10 Hz
constexpr double kRateTolerance = 0.01;                           // 29.97 counts as 30

double rate_of(const v4l2_fract& interval) noexcept {
  return interval.numerator == 0 ? 0.0 : static_cast<double>(interval.denominator) / interval.numerator;
}

std::size_t cost_rank(std::uint32_t fourcc) noexcept {
  std::size_t rank = 0;
  while (rank < kReadable.size() && kReadable[rank].fourcc != fourcc) ++rank;
  return rank;
}

double best_rate(const V4l2Device& device, std::uint32_t fourcc, const Size& size) {
  v4l2_frmivalenum interval{};
  interval.pixel_format = fourcc;
  interval.width = static_cast<std::uint32_t>(size.width_px);
  interval.height = static_cast<std::uint32_t>(size.height_px);
  double best = 0.0;
  while (device.call(VIDIOC_ENUM_FRAMEINTERVALS, interval) == 0) {
    if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE) return rate_of(interval.stepwise.min);
    best = std::max(best, rate_of(interval.discrete));
    ++interval.index;
  }
  return best;
}

bool lies_within(const v4l2_frmsize_stepwise& range, const Size& size) noexcept {
  const auto fits = [](int value, std::uint32_t least, std::uint32_t most, std::uint32_t step) {
    const auto v = static_cast<std::uint32_t>(value);
    return v >= least && v <= most && (step == 0 || (v - least) % step == 0);
  };
  return fits(size.width_px, range.min_width, range.max_width, range.step_width) &&
         fits(size.height_px, range.min_height, range.max_height, range.step_height);
}

std::vector<Size> sizes_of(const V4l2Device& device, std::uint32_t fourcc, const WantedMode& wanted) {
  std::vector<Size> sizes;
  v4l2_frmsizeenum entry{};
  entry.pixel_format = fourcc;
  for (; device.call(VIDIOC_ENUM_FRAMESIZES, entry) == 0; ++entry.index) {
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      sizes.push_back({static_cast<int>(entry.discrete.width), static_cast<int>(entry.discrete.height)});
      continue;
    }
    const Size asked{wanted.width_px, wanted.height_px};
    if (asked.width_px > 0 && lies_within(entry.stepwise, asked)) sizes.push_back(asked);
    for (const Size& common : kCommonSizes) {
      if (lies_within(entry.stepwise, common)) sizes.push_back(common);
    }
    break;
  }
  if (!sizes.empty()) return sizes;
  V4l2Picture now;  // for a driver that does not list sizes (HDMI input): its present one
  if (device.picture(now) == 0) sizes.push_back({static_cast<int>(now.width), static_cast<int>(now.height)});
  return sizes;
}

bool fits(const V4l2Mode& mode, const WantedMode& wanted) {
  if (!wanted.format.empty() && fourcc_text(mode.fourcc) != wanted.format) return false;
  if (wanted.width_px > 0) return mode.width_px == wanted.width_px && mode.height_px == wanted.height_px;
  return mode.width_px <= kLargestWidth_px && mode.height_px <= kLargestHeight_px;
}

}  // namespace

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (unsigned byte = 0; byte < 4; ++byte) text += static_cast<char>(fourcc >> 8U * byte & 0x7FU);
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

std::string mode_text(const V4l2Mode& mode) {
  return fmt::format("{} {} x {}{}", fourcc_text(mode.fourcc), mode.width_px, mode.height_px,
                     mode.rate_hz > 0 ? fmt::format(" at up to {:.4g} Hz", mode.rate_hz) : "");
}

std::optional<PixelLayout> layout_of(std::uint32_t fourcc) noexcept {
  const std::size_t rank = cost_rank(fourcc);
  if (rank == kReadable.size()) return std::nullopt;
  return kReadable[rank].layout;
}

std::vector<V4l2Mode> list_modes(const V4l2Device& device, const WantedMode& wanted) {
  std::vector<V4l2Mode> modes;
  v4l2_fmtdesc format{};
  format.type = device.buffer_type();
  for (; device.call(VIDIOC_ENUM_FMT, format) == 0; ++format.index) {
    const std::optional<PixelLayout> layout = layout_of(format.pixelformat);
    if (!layout) continue;
    for (const Size& size : sizes_of(device, format.pixelformat, wanted)) {
      modes.push_back(
          {format.pixelformat, *layout, size.width_px, size.height_px, best_rate(device, format.pixelformat, size)});
    }
  }
  return modes;
}

V4l2Mode choose_mode(const std::vector<V4l2Mode>& modes, const WantedMode& wanted, const std::string& device) {
  const double least_hz = (wanted.rate_hz > 0 ? wanted.rate_hz : kUsableRate_hz) * (1.0 - kRateTolerance);
  const V4l2Mode* best = nullptr;
  const auto score = [&](const V4l2Mode& mode) {
    const bool is_fast_enough = mode.rate_hz == 0.0 || mode.rate_hz >= least_hz;
    const double speed = is_fast_enough && wanted.rate_hz > 0 ? 0.0 : mode.rate_hz;  // no benefit above the wanted rate
    return std::tuple(is_fast_enough, is_fast_enough ? mode.width_px * mode.height_px : 0, speed,
                      -static_cast<int>(cost_rank(mode.fourcc)));
  };
  for (const V4l2Mode& mode : modes) {
    if (fits(mode, wanted) && (best == nullptr || score(mode) > score(*best))) best = &mode;
  }
  if (best != nullptr && wanted.rate_hz > 0 && best->rate_hz > 0 && best->rate_hz < least_hz) best = nullptr;
  if (best != nullptr) return *best;
  std::vector<std::string> offered;
  for (const V4l2Mode& mode : modes) offered.push_back(mode_text(mode));
  throw std::runtime_error(fmt::format(
      "{}: no mode as wanted ({}{}{}): it offers {}: change camera.size, camera.rate_hz or camera.format", device,
      wanted.format.empty() ? "any format" : wanted.format,
      wanted.width_px > 0 ? fmt::format(", {} x {}", wanted.width_px, wanted.height_px) : "",
      wanted.rate_hz > 0 ? fmt::format(", {:g} Hz", wanted.rate_hz) : "",
      offered.empty() ? std::string("no format that can be read here") : fmt::format("{}", fmt::join(offered, "; "))));
}

MadeMode make_mode(const V4l2Device& device, const V4l2Mode& mode, double rate_hz) {
  const auto refuse = [&](const char* what, int error) {
    throw std::runtime_error(fmt::format("{}: {} refused {}: {}: is another program using the camera?", device.path(),
                                         what, mode_text(mode), std::strerror(error)));
  };
  V4l2Picture got{static_cast<std::uint32_t>(mode.width_px), static_cast<std::uint32_t>(mode.height_px), mode.fourcc,
                  V4L2_FIELD_NONE};  // interlaced fields of different times cannot be used
  if (const int error = device.set_picture(got); error != 0) refuse("VIDIOC_S_FMT", error);
  if (got.fourcc != mode.fourcc || got.width != static_cast<std::uint32_t>(mode.width_px) ||
      got.height != static_cast<std::uint32_t>(mode.height_px) || got.field != V4L2_FIELD_NONE) {
    throw std::runtime_error(
        fmt::format("{}: asked for {}, the device made {} {} x {}{} of it: set camera.size and camera.format",
                    device.path(), mode_text(mode), fourcc_text(got.fourcc), got.width, got.height,
                    got.field == V4L2_FIELD_NONE ? "" : ", interlaced,"));
  }
  MadeMode made{mode, mode.layout == PixelLayout::kMjpeg ? 0 : got.stride_bytes};
  v4l2_streamparm parameters{};
  parameters.type = device.buffer_type();
  if (device.call(VIDIOC_G_PARM, parameters) != 0) return made;
  v4l2_fract& interval = parameters.parm.capture.timeperframe;
  if ((parameters.parm.capture.capability & V4L2_CAP_TIMEPERFRAME) != 0) {
    const double wanted_hz = rate_hz > 0 ? rate_hz : mode.rate_hz;
    if (wanted_hz > 0) interval = {10000, static_cast<std::uint32_t>(std::lround(10000.0 * wanted_hz))};
    if (const int error = device.call(VIDIOC_S_PARM, parameters); error != 0) refuse("VIDIOC_S_PARM", error);
  }
  if (const double stated_hz = rate_of(interval); stated_hz > 0) made.mode.rate_hz = stated_hz;
  return made;
}

}  // namespace drivers
