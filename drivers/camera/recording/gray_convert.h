#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "core/types/frame.h"

namespace drivers {

enum class GrayStatus : std::uint8_t { kOk, kEmpty, kNot8Bit, kChannelCount, kSizeMismatch, kConversionFailed };

// Text for the user, without file name or values.
[[nodiscard]] const char* to_string(GrayStatus status) noexcept;

// 8-bit gray, BGR or BGRA image -> `out.pixels`, in one pass and without a copy in between. `out.pixels` must already
// hold rows * cols bytes; it is never reallocated. Alpha is ignored: a caller for which it matters must check it
// before. Luma as in OpenCV: 0.299 R + 0.587 G + 0.114 B. Sets width_px and height_px and no other field.
[[nodiscard]] GrayStatus convert_to_gray(const cv::Mat& image, core::Frame& out) noexcept;

}  // namespace drivers
