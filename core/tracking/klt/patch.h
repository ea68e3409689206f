#pragma once

#include <array>
#include <cstdint>

#include "core/types/gray_view.h"

namespace core {

// Sizes of the patches about a tracked point, px. Window: largest compared part. Patch: the pixels from which a
// template is interpolated at every place within a pixel, and its gradients.
inline constexpr int kWindowRadius = 10;
inline constexpr int kWindow = 2 * kWindowRadius + 1;
inline constexpr int kGradientRadius = 3;  // of the Gaussian derivative
inline constexpr int kShiftTaps = 20;      // of an interpolation (fractional_shift.h)
inline constexpr int kPatchRadius = kWindowRadius + 1 + kGradientRadius + kShiftTaps / 2;
inline constexpr int kPatch = 2 * kPatchRadius + 1;

// A template's window keeps its place in the template: where that lies between pixels, its outer ones count in part,
// and it covers one row and column more, which all windows have.
inline constexpr int kSide = kWindow + 1;
[[nodiscard]] constexpr int side_of(int radius) noexcept { return 2 * radius + 2; }

// Windows in memory: kSide rows of kRow elements, the window's pixels first, zeros after them.
inline constexpr int kRow = 24;
inline constexpr int kWindowSize = kSide * kRow;

// Grey values, centred on the point.
using Patch = std::array<std::array<float, kPatch>, kPatch>;

// Index of the pixel at index `i` of a line of `n`; mirrored beyond the border.
[[nodiscard]] inline int mirrored(int i, int n) noexcept {
  if (n == 1) return 0;
  const int period = 2 * (n - 1);
  int k = i % period;
  if (k < 0) k += period;
  return k < n ? k : period - k;
}

// Cuts the patch about the pixel (u, v).
inline void cut_patch(const GrayView& gray, int u, int v, Patch& out) noexcept {
  for (int y = 0; y < kPatch; ++y) {
    const std::uint8_t* row = gray.row(mirrored(v - kPatchRadius + y, gray.height));
    for (int x = 0; x < kPatch; ++x)
      out[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)] = row[mirrored(u - kPatchRadius + x, gray.width)];
  }
}

}  // namespace core
