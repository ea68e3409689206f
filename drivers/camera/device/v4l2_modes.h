#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "drivers/camera/device/luma.h"
#include "drivers/camera/device/v4l2_device.h"

namespace drivers {

// One readable image mode of a device.
struct V4l2Mode {
  std::uint32_t fourcc = 0;
  PixelLayout layout = PixelLayout::kGray8;
  int width_px = 0;
  int height_px = 0;
  double rate_hz = 0.0;  // the highest at this size; 0 = not stated by the driver
};

struct WantedMode {
  int width_px = 0, height_px = 0;  // 0 = the largest image up to 1920 x 1080
  double rate_hz = 0.0;             // 0 = the highest
  std::string format{};             // four characters, e.g. YUYV; empty = any
};

[[nodiscard]] std::string fourcc_text(std::uint32_t fourcc);
[[nodiscard]] std::string mode_text(const V4l2Mode& mode);  // "YUYV 640 x 480 at up to 30 Hz"
[[nodiscard]] std::optional<PixelLayout> layout_of(std::uint32_t fourcc) noexcept;

// All readable modes that the device lists. Sizes and rates given as ranges are evaluated at `wanted` and at common
// values within.
[[nodiscard]] std::vector<V4l2Mode> list_modes(const V4l2Device& device, const WantedMode& wanted);

// The largest image that is delivered at the wanted rate (none wanted: at least 25 Hz, then as fast as possible); among
// equals the format that is cheapest to read, MJPEG last, because its compression moves edges by hundredths of a pixel.
// Throws std::runtime_error with a list of the modes when none fits.
[[nodiscard]] V4l2Mode choose_mode(const std::vector<V4l2Mode>& modes, const WantedMode& wanted,
                                   const std::string& device);

struct MadeMode {
  V4l2Mode mode;                 // with the rate now stated by the device
  std::size_t stride_bytes = 0;  // from row to row
};

// Sets the mode and reads it back. Throws std::runtime_error when the device changes it.
[[nodiscard]] MadeMode make_mode(const V4l2Device& device, const V4l2Mode& mode, double rate_hz);

}  // namespace drivers
