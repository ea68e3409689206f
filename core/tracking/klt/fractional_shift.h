#pragma once

#include <array>
#include <cstddef>

#include "core/tracking/klt/patch.h"
#include "core/types/constants.h"

namespace core {

// sin(pi x), 0 <= x <= 1, to 1e-13: the same bits on every machine, which the C library's does not promise.
[[nodiscard]] constexpr double sine_of_half_turn(double x) noexcept {
  const double y = kPi * (x - 0.5), square = y * y;
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < 11; ++k) {
    term *= -square / ((2.0 * k - 1.0) * (2.0 * k));
    sum += term;
  }
  return sum;
}
// I_0(2 sqrt(quarter)), Bessel function of imaginary argument.
[[nodiscard]] constexpr double bessel_i0(double quarter) noexcept {
  double term = 1.0, sum = 1.0;
  for (int k = 1; k < 25; ++k) {
    term *= quarter / (static_cast<double>(k) * k);
    sum += term;
  }
  return sum;
}

// Interpolation between samples: f(x - shift) = sum_k taps[k] f(x + first + k). Sinc with a Kaiser window (Kaiser
// 1974); with 20 taps a sinusoid of up to 0.38 cycles per sample is displaced by at most 1e-4 samples.
struct FractionalShift {
  int first = 0;
  std::array<double, kShiftTaps> taps{};
};

[[nodiscard]] constexpr FractionalShift fractional_shift(double shift) noexcept {
  constexpr double kShape = 7.5, kHalfLength = 0.5 * kShiftTaps;
  const int towards_zero = static_cast<int>(shift);
  const int whole = towards_zero > shift ? towards_zero - 1 : towards_zero;
  const double rest = shift - whole;  // 0 ... 1
  FractionalShift out{-whole - kShiftTaps / 2, {}};
  std::array<double, kShiftTaps> window{};
  double sum = 0.0, of_window = 0.0;
  for (std::size_t k = 0; k < kShiftTaps; ++k) {
    const int n = static_cast<int>(k) - kShiftTaps / 2;  // tap at x - whole + n
    const double from = n + rest, inside = 1.0 - (from / kHalfLength) * (from / kHalfLength);
    const double sinc = n == 0 && rest == 0.0 ? kPi : (n % 2 == 0 ? 1.0 : -1.0) * sine_of_half_turn(rest) / from;
    window[k] = inside > 0.0 ? bessel_i0(0.25 * kShape * kShape * inside) : 0.0;
    out.taps[k] = sinc * window[k];
    sum += out.taps[k];
    of_window += from * from * window[k];
  }
  double moment = 0.0;
  for (std::size_t k = 0; k < kShiftTaps; ++k) {
    out.taps[k] /= sum;
    moment += (static_cast<int>(k) - kShiftTaps / 2 + rest) * out.taps[k];
  }
  // Smooth texture is displaced by exactly the shift.
  for (std::size_t k = 0; k < kShiftTaps; ++k)
    out.taps[k] -= moment / of_window * (static_cast<int>(k) - kShiftTaps / 2 + rest) * window[k];
  return out;
}

}  // namespace core
