#include "core/tracking/klt/window_sums.h"

#include "core/linear/vector_clones.h"

namespace core {

namespace {

constexpr std::array<std::int16_t, kWindowSize> all_ones() {
  std::array<std::int16_t, kWindowSize> out{};
  out.fill(1);
  return out;
}
alignas(64) constexpr std::array<std::int16_t, kWindowSize> kOnes = all_ones();

// The sum of the pixels as a product: compilers then use one multiply-and-add instruction for each of the five.
HOVERMODAL_VECTOR_CLONES
void add_products(const std::int16_t* __restrict pixels, const std::int16_t* __restrict step_u,
                  const std::int16_t* __restrict step_v, const std::int16_t* __restrict texture,
                  const std::int16_t* __restrict ones, std::int32_t* __restrict out) {
  std::int32_t u = 0, v = 0, t = 0, sum = 0, square = 0;
  for (int i = 0; i < kWindowSize; ++i) {
    u += pixels[i] * step_u[i];
    v += pixels[i] * step_v[i];
    t += pixels[i] * texture[i];
    sum += pixels[i] * ones[i];
    square += pixels[i] * pixels[i];
  }
  out[0] = u, out[1] = v, out[2] = t, out[3] = sum, out[4] = square;
}

// A row of 22 pixels is two overlapping vectors of 16, each in a pass of its own.
HOVERMODAL_VECTOR_CLONES
void copy_rows(const std::uint8_t* __restrict from, std::size_t stride, std::int16_t* __restrict to) {
  constexpr int kVector = 16, kSecond = kSide - kVector;
  for (std::size_t y = 0; y < kSide; ++y)
    for (std::size_t x = 0; x < kVector; ++x) to[y * kRow + x] = from[y * stride + x];
  for (std::size_t y = 0; y < kSide; ++y)
    for (std::size_t x = 0; x < kVector; ++x) to[y * kRow + kSecond + x] = from[y * stride + kSecond + x];
}

}  // namespace

void copy_window(const GrayView& gray, int u, int v, int radius, RawWindow& out) noexcept {
  const std::uint8_t* from = gray.row(v - radius) + (u - radius);
  if (radius == kWindowRadius) return copy_rows(from, gray.stride, out.data());
  const auto n = static_cast<std::size_t>(side_of(radius));
  for (std::size_t y = 0; y < n; ++y, from += gray.stride)
    for (std::size_t x = 0; x < n; ++x) out[y * kRow + x] = from[x];
}

void prefetch_window(const GrayView& gray, int u, int v, int radius) noexcept {
  const std::uint8_t* from = gray.row(v - radius) + (u - radius);
  const int last = side_of(radius) - 1;
  const std::size_t two_rows = 2 * gray.stride;
  for (int y = 0; y < last; y += 2, from += two_rows) {  // an even number of rows
    for (const std::uint8_t* row : {from, from + gray.stride}) {
      __builtin_prefetch(row);
      __builtin_prefetch(row + last);  // a row may lie in two lines of the cache
    }
  }
}

void prefetch_phase(const Phase& phase) noexcept {
  constexpr std::size_t kLine = 64, kLines = 16;  // so many in a round, without a loop of their own
  const char* from = reinterpret_cast<const char*>(&phase);
  for (std::size_t k = 0; k < sizeof(Phase); k += kLines * kLine)
    for (std::size_t line = 0; line < kLines; ++line) __builtin_prefetch(from + k + line * kLine);
}

WindowSums sums_over(const RawWindow& window, const Phase& phase) noexcept {
  std::array<std::int32_t, 5> sums{};
  add_products(window.data(), phase.step_u.data(), phase.step_v.data(), phase.texture.data(), kOnes.data(),
               sums.data());
  return {sums[0], sums[1], sums[2], sums[3], sums[4]};
}

}  // namespace core
