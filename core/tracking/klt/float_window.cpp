#include "core/tracking/klt/float_window.h"

#include <algorithm>

#include "core/linear/vector_clones.h"

namespace core {

namespace {

constexpr std::size_t kLanes = 16, kParts = 4, kPixels = kWindowSize;
using Lanes = std::array<float, kLanes>;

// Sums of which total() adds up kParts each.
template <std::size_t kSums>
using Parts = std::array<float, kSums * kParts>;

// Adds up lanes in pairs; the rest is left for total().
inline void fold(Lanes& lanes, float* out) {
  for (std::size_t l = 0; l < 8; ++l) lanes[l] += lanes[l + 8];
  for (std::size_t l = 0; l < kParts; ++l) out[l] = lanes[l] + lanes[l + kParts];
}
double total(const float* parts) {
  return (static_cast<double>(parts[0]) + static_cast<double>(parts[1])) +
         (static_cast<double>(parts[2]) + static_cast<double>(parts[3]));
}

HOVERMODAL_VECTOR_CLONES
void add_up(const float* __restrict a, float* __restrict out) {
  Lanes sum{};
  for (std::size_t i = 0; i < kPixels; i += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) sum[l] += a[i + l];
  fold(sum, out);
}

HOVERMODAL_VECTOR_CLONES
void multiply(const float* a, const float* b, float* __restrict out) {  // a and b may be the same
  Lanes sum{};
  for (std::size_t i = 0; i < kPixels; i += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) sum[l] += a[i + l] * b[i + l];
  fold(sum, out);
}

HOVERMODAL_VECTOR_CLONES
void multiply_three(const float* __restrict window, const float* __restrict a, const float* __restrict b,
                    const float* __restrict c, float* __restrict out) {
  Lanes of_a{}, of_b{}, of_c{}, sum{}, square{};
  for (std::size_t i = 0; i < kPixels; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float value = window[i + l];
      of_a[l] += value * a[i + l], of_b[l] += value * b[i + l], of_c[l] += value * c[i + l];
      sum[l] += value, square[l] += value * value;
    }
  }
  fold(of_a, out), fold(of_b, out + kParts), fold(of_c, out + 2 * kParts);
  fold(sum, out + 3 * kParts), fold(square, out + 4 * kParts);
}

HOVERMODAL_VECTOR_CLONES
void add_multiple(float factor, const float* __restrict from, float* __restrict to) {
  for (std::size_t i = 0; i < kPixels; ++i) to[i] += factor * from[i];
}

HOVERMODAL_VECTOR_CLONES
void combine_two(float a_factor, const float* __restrict a, float b_factor, const float* __restrict b,
                 float* __restrict out) {
  for (std::size_t i = 0; i < kPixels; ++i) out[i] = a_factor * a[i] + b_factor * b[i];
}

HOVERMODAL_VECTOR_CLONES
void multiply_each(const float* __restrict a, const float* __restrict b, float* __restrict out) {
  for (std::size_t i = 0; i < kPixels; ++i) out[i] = a[i] * b[i];
}

constexpr std::array<float, kPixels> places(bool is_row) {
  std::array<float, kPixels> out{};
  for (std::size_t i = 0; i < kPixels; ++i) out[i] = static_cast<float>(is_row ? i / kRow : i % kRow);
  return out;
}
alignas(64) constexpr std::array<float, kPixels> kColumns = places(false), kRows = places(true);

HOVERMODAL_VECTOR_CLONES
void find_largest(const float* __restrict a, float* __restrict out) {
  Lanes most{};
  for (std::size_t i = 0; i < kPixels; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const float value = a[i + l], size = value < 0.0F ? -value : value;
      most[l] = size > most[l] ? size : most[l];
    }
  }
  for (std::size_t l = 0; l < kLanes; ++l) out[l] = most[l];
}

// Half a unit away from zero, then cut off: lround() without its call.
HOVERMODAL_VECTOR_CLONES
void round_all(const float* __restrict from, float scale, std::int16_t* __restrict out) {
  for (std::size_t i = 0; i < kPixels; ++i) {
    const float value = scale * from[i];
    out[i] = static_cast<std::int16_t>(static_cast<std::int32_t>(value + (value < 0.0F ? -0.5F : 0.5F)));
  }
}

}  // namespace

double sum_over(const FloatWindow& a) noexcept {
  Parts<1> sums;
  add_up(a.data(), sums.data());
  return total(sums.data());
}

double product(const FloatWindow& a, const FloatWindow& b) noexcept {
  Parts<1> sums;
  multiply(a.data(), b.data(), sums.data());
  return total(sums.data());
}

WindowProducts products(const FloatWindow& window, const FloatWindow& a, const FloatWindow& b,
                        const FloatWindow& c) noexcept {
  Parts<5> sums;
  multiply_three(window.data(), a.data(), b.data(), c.data(), sums.data());
  const auto of = [&](std::size_t k) { return total(sums.data() + k * kParts); };
  return {of(0), of(1), of(2), of(3), of(4)};
}

void add_scaled(float factor, const FloatWindow& from, FloatWindow& to) noexcept {
  add_multiple(factor, from.data(), to.data());
}

void combine(float a_factor, const FloatWindow& a, float b_factor, const FloatWindow& b, FloatWindow& out) noexcept {
  combine_two(a_factor, a.data(), b_factor, b.data(), out.data());
}

void times_column(const FloatWindow& from, FloatWindow& out) noexcept {
  multiply_each(from.data(), kColumns.data(), out.data());
}

void times_row(const FloatWindow& from, FloatWindow& out) noexcept {
  multiply_each(from.data(), kRows.data(), out.data());
}

double largest(const FloatWindow& a) noexcept {
  Lanes most;
  find_largest(a.data(), most.data());
  return static_cast<double>(*std::max_element(most.begin(), most.end()));
}

void round_scaled(const FloatWindow& from, float scale, std::array<std::int16_t, kWindowSize>& out) noexcept {
  round_all(from.data(), scale, out.data());
}

}  // namespace core
