#pragma once

#include <array>
#include <cstdint>

#include "core/tracking/klt/quintic_spline.h"
#include "core/types/gray_view.h"

namespace core {

// Sizes of the patches about a tracked point, px. Window: largest compared part. Folded: the window plus the
// support of the interpolation's prefilter. Patch: the pixels that interpolation needs for every position within
// one pixel.
inline constexpr int kWindowRadius = 10;
inline constexpr int kWindow = 2 * kWindowRadius + 1;
inline constexpr int kFoldedRadius = kWindowRadius + kPrefilterMargin;
inline constexpr int kFolded = 2 * kFoldedRadius + 1;
inline constexpr int kPatchRadius = kFoldedRadius + kSplineBefore + 1;
inline constexpr int kPatch = 2 * kPatchRadius + 1;
inline constexpr int kImageRows = kFolded + kSplineTaps - 1;  // of the image about a cell, and as many columns: 37 are
inline constexpr int kImageColumns = 40;                      // needed, whole vectors are read
inline constexpr int kRow = 32;                               // row length of folded windows in memory: whole vectors

// Grey values, centred on the point.
using Patch = std::array<std::array<double, kPatch>, kPatch>;

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
