#pragma once

#include <cstdint>

#include <opencv2/core/mat.hpp>

#include "core/types/frame.h"

namespace drivers {

enum class GrayStatus : std::uint8_t { kOk, kEmpty, kNot8Bit, kChannelCount, kSizeMismatch, kConversionFailed };

// What to tell the user, without file name or values.
[[nodiscard]] const char* to_string(GrayStatus status) noexcept;

// 8-bit gray, BGR or BGRA image -> `out.pixels`, in one pass and without a copy in between. `out.pixels` must already
// hold rows * cols bytes; it is never reallocated. Alpha is ignored: a caller that must not ignore it asks beforehand.
// Luma as OpenCV has it: 0.299 R + 0.587 G + 0.114 B. Sets width_px and height_px, leaves the other fields alone.
[[nodiscard]] GrayStatus convert_to_gray(const cv::Mat& image, core::Frame& out) noexcept;

}  // namespace drivers
