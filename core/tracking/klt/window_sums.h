#pragma once

#include <array>
#include <cstdint>

#include "core/tracking/klt/phase.h"
#include "core/types/gray_view.h"

namespace core {

// Raw pixels in the layout of patch.h.
struct alignas(64) RawWindow : std::array<std::int16_t, kWindowSize> {};

// Copies the window about the pixel (u, v), which lies in the image. `out` keeps its zeros beside the window.
void copy_window(const GrayView& gray, int u, int v, int radius, RawWindow& out) noexcept;

// Fetches the window's pixels and a phase into the cache.
void prefetch_window(const GrayView& gray, int u, int v, int radius) noexcept;
void prefetch_phase(const Phase& phase) noexcept;

// Sums over a window, of integers: bit-identical on every machine.
struct WindowSums {
  std::int32_t step_u = 0, step_v = 0, texture = 0;  // pixel times factor
  std::int32_t sum = 0, square = 0;                  // of the pixels
};
[[nodiscard]] WindowSums sums_over(const RawWindow& window, const Phase& phase) noexcept;

}  // namespace core
