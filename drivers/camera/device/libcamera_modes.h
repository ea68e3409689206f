#pragma once

#include <libcamera/libcamera.h>

#include <optional>

#include "drivers/camera/device/luma.h"

namespace drivers {

struct LibcameraMode {
  libcamera::PixelFormat format;
  PixelLayout layout = PixelLayout::kGray8;
  libcamera::Size size;
};

// The format that is cheapest to read among those offered, of several the one that libcamera has chosen in `stream`, in
// that size; null size: the largest up to 1920 x 1080. Empty: no format that can be read here.
[[nodiscard]] std::optional<LibcameraMode> choose_mode(const libcamera::StreamConfiguration& stream,
                                                       libcamera::Size wanted);

}  // namespace drivers
