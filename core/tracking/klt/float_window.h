#pragma once

#include <array>
#include <cstdint>

#include "core/tracking/klt/patch.h"

namespace core {

// A window of grey values, or of factors for them; in memory as in patch.h.
struct alignas(64) FloatWindow : std::array<float, kWindowSize> {};

// Sums over windows are made in 16 lanes, whatever the machine's vectors: bit-identical everywhere.
[[nodiscard]] double sum_over(const FloatWindow& a) noexcept;
[[nodiscard]] double product(const FloatWindow& a, const FloatWindow& b) noexcept;

// A window's products with three others, its sum and its square.
struct WindowProducts {
  double a = 0.0, b = 0.0, c = 0.0, sum = 0.0, square = 0.0;
};
[[nodiscard]] WindowProducts products(const FloatWindow& window, const FloatWindow& a, const FloatWindow& b,
                                      const FloatWindow& c) noexcept;

// to += factor from
void add_scaled(float factor, const FloatWindow& from, FloatWindow& to) noexcept;
// out = a_factor a + b_factor b
void combine(float a_factor, const FloatWindow& a, float b_factor, const FloatWindow& b, FloatWindow& out) noexcept;
// Each pixel times its column or row in the window, counted from its first pixel.
void times_column(const FloatWindow& from, FloatWindow& out) noexcept;
void times_row(const FloatWindow& from, FloatWindow& out) noexcept;

// Largest size of a value.
[[nodiscard]] double largest(const FloatWindow& a) noexcept;
// Values times scale, rounded.
void round_scaled(const FloatWindow& from, float scale, std::array<std::int16_t, kWindowSize>& out) noexcept;

}  // namespace core
