#include "core/tracking/klt/shifted_windows.h"

#include "core/linear/vector_clones.h"
#include "core/tracking/klt/fractional_shift.h"

namespace core {

namespace {

struct Taps {
  int first = 0;
  std::array<float, kShiftTaps> taps{};
};

constexpr std::array<Taps, kShifts> all_taps() {
  std::array<Taps, kShifts> out{};
  for (int i = 0; i < kShifts; ++i) {
    const FractionalShift shift = fractional_shift(static_cast<double>(kFirstShift + i) / kShiftsPerPixel);
    Taps& taps = out[static_cast<std::size_t>(i)];
    taps.first = shift.first;
    for (std::size_t k = 0; k < kShiftTaps; ++k) taps.taps[k] = static_cast<float>(shift.taps[k]);
  }
  return out;
}
constexpr std::array<Taps, kShifts> kTaps = all_taps();

constexpr int kPatchRow = 52;

// Rows of a patch, each at `kWideRow` places.
HOVERMODAL_VECTOR_CLONES
void filter_along(const float* __restrict in, const float* __restrict taps, float* __restrict out) {
  for (int y = 0; y < kPatch; ++y, in += kPatchRow, out += kWideRow) {
    std::array<float, kWideRow> sum{};
    for (std::size_t k = 0; k < kShiftTaps; ++k)
      for (std::size_t x = 0; x < kWideRow; ++x) sum[x] += taps[k] * in[x + k];
    for (std::size_t x = 0; x < kWideRow; ++x) out[x] = sum[x];
  }
}

// kColumns columns at n_rows places.
template <std::size_t kColumns>
inline void filter_across(const float* __restrict in, const float* __restrict taps, int n_rows, int row,
                          float* __restrict out) {
  for (int y = 0; y < n_rows; ++y, in += kWideRow, out += row) {
    std::array<float, kColumns> sum{};
    for (std::size_t k = 0; k < kShiftTaps; ++k)
      for (std::size_t x = 0; x < kColumns; ++x) sum[x] += taps[k] * in[k * kWideRow + x];
    for (std::size_t x = 0; x < kColumns; ++x) out[x] = sum[x];
  }
}
HOVERMODAL_VECTOR_CLONES
void filter_window(const float* in, const float* taps, int n_rows, float* out) {
  filter_across<kRow>(in, taps, n_rows, kRow, out);
}
HOVERMODAL_VECTOR_CLONES
void filter_wide(const float* in, const float* taps, float* out) {
  filter_across<kWideRow>(in, taps, kWide, kWideRow, out);
}

std::size_t index(int i) { return static_cast<std::size_t>(i); }

}  // namespace

ShiftedWindows::ShiftedWindows(const Patch& patch, int radius, float level) noexcept : radius_(radius), across_{} {
  alignas(64) std::array<std::array<float, kPatchRow>, kPatch> rows{};
  for (std::size_t y = 0; y < kPatch; ++y)
    for (std::size_t x = 0; x < kPatch; ++x) rows[y][x] = patch[y][x] - level;
  for (std::size_t i = 0; i < kShifts; ++i) {
    filter_along(&rows[0][index(kPatchRadius - kWideRadius + kTaps[i].first)], kTaps[i].taps.data(),
                 across_[i][0].data());
  }
}

void ShiftedWindows::window(int shift_u, int shift_v, FloatWindow& out) const noexcept {
  const Across& from = across_[index(shift_u - kFirstShift)];
  const Taps& taps = kTaps[index(shift_v - kFirstShift)];
  const int n = side_of(radius_);
  filter_window(&from[index(kPatchRadius - radius_ + taps.first)][index(kWideRadius - radius_)], taps.taps.data(), n,
                out.data());
  for (int y = 0; y < n; ++y)
    for (int x = n; x < kRow; ++x) out[index(y * kRow + x)] = 0.0F;
  for (std::size_t i = index(n * kRow); i < kWindowSize; ++i) out[i] = 0.0F;
}

void ShiftedWindows::wide(int shift_u, int shift_v, WideWindow& out) const noexcept {
  const Across& from = across_[index(shift_u - kFirstShift)];
  const Taps& taps = kTaps[index(shift_v - kFirstShift)];
  filter_wide(from[index(kPatchRadius - kWideRadius + taps.first)].data(), taps.taps.data(), out[0].data());
}

}  // namespace core
