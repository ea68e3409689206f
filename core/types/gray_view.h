#pragma once

#include <cstddef>
#include <cstdint>

#include "core/types/frame.h"

namespace core {

// View of 8-bit grey pixels owned by another object. Empty: width and height are 0.
struct GrayView {
  const std::uint8_t* pixels = nullptr;
  int width = 0, height = 0;
  std::size_t stride = 0;  // bytes from row to row

  [[nodiscard]] const std::uint8_t* row(int v) const noexcept { return pixels + static_cast<std::size_t>(v) * stride; }
  [[nodiscard]] bool empty() const noexcept { return width <= 0 || height <= 0; }
};

// Empty if the frame has fewer pixels than its size requires.
[[nodiscard]] inline GrayView gray_view(const Frame& frame) noexcept {
  if (frame.width_px <= 0 || frame.height_px <= 0) return {};
  const auto width = static_cast<std::size_t>(frame.width_px), height = static_cast<std::size_t>(frame.height_px);
  if (frame.pixels.size() < width * height) return {};
  return {frame.pixels.data(), frame.width_px, frame.height_px, width};
}

}  // namespace core
