#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/types/frame.h"

// Pictures that carry their numbers: a dark or bright stripe for each bit, the lowest first.
namespace test_support {

constexpr int kNumberBits = 12, kBitWidth_px = 16, kNumberedHeight_px = 64;
constexpr int kNumberedWidth_px = kNumberBits * kBitWidth_px;

// The number that the picture carries; empty if any of it is damaged: one stripe is not of one level.
inline std::optional<unsigned> number_in(const core::Frame& frame) {
  unsigned number = 0;
  for (int bit = 0; bit < kNumberBits; ++bit) {
    int n_bright = 0, n_dark = 0;
    for (int y = 4; y < kNumberedHeight_px - 4; ++y) {
      for (int x = bit * kBitWidth_px + 4; x < (bit + 1) * kBitWidth_px - 4; ++x) {
        const std::uint8_t level = frame.pixels[static_cast<std::size_t>(y * kNumberedWidth_px + x)];
        n_bright += level > 150 ? 1 : 0, n_dark += level < 90 ? 1 : 0;
      }
    }
    const int all = (kBitWidth_px - 8) * (kNumberedHeight_px - 8);
    if (n_bright != all && n_dark != all) return std::nullopt;
    if (n_bright == all) number |= 1U << static_cast<unsigned>(bit);
  }
  return number;
}

}  // namespace test_support
