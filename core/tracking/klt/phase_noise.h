#pragma once

#include <array>
#include <cstddef>

#include "core/tracking/klt/fractional_shift.h"
#include "core/tracking/klt/shifted_windows.h"

namespace core {

// exp(-k^2 / (2 0.7^2)), k = 0 ... 3: smoothing across the gradient; multiplied by k, the derivative along it.
inline constexpr std::array<double, kGradientRadius + 1> kGauss{1.0, 0.36044778859782, 0.01687989150494,
                                                                0.00010269492446};
using GradientTaps = std::array<double, 2 * kGradientRadius + 1>;
[[nodiscard]] constexpr GradientTaps gaussian() {
  constexpr double kSum = kGauss[0] + 2.0 * (kGauss[1] + kGauss[2] + kGauss[3]);
  GradientTaps taps{};
  for (int k = -kGradientRadius; k <= kGradientRadius; ++k)
    taps[static_cast<std::size_t>(k + kGradientRadius)] = kGauss[static_cast<std::size_t>(k < 0 ? -k : k)] / kSum;
  return taps;
}
[[nodiscard]] constexpr GradientTaps gaussian_slope() {
  constexpr double kSum = 2.0 * (kGauss[1] + 4.0 * kGauss[2] + 9.0 * kGauss[3]);
  GradientTaps taps{};
  for (int k = -kGradientRadius; k <= kGradientRadius; ++k)
    taps[static_cast<std::size_t>(k + kGradientRadius)] = k * kGauss[static_cast<std::size_t>(k < 0 ? -k : k)] / kSum;
  return taps;
}

// What white noise of variance 1 in a patch adds, along one axis, to products of a window at a phase with the
// window displaced by a node (in sixths of a pixel, from -kReach on).
struct NoiseOfPhase {
  std::array<double, kNodes> slope{}, smooth{}, same{};  // of the derivative, the smoothed and the unfiltered window
  std::array<double, kNodes> square{};                   // of the displaced window with itself
};

[[nodiscard]] constexpr NoiseOfPhase noise_of_phase(int phase) {
  constexpr std::size_t kLength = 64, kMiddle = 32;
  using Response = std::array<double, kLength>;
  const auto response = [](int sixths) {
    const FractionalShift shift = fractional_shift(static_cast<double>(sixths) / kShiftsPerPixel);
    Response out{};
    for (std::size_t k = 0; k < kShiftTaps; ++k)
      out[static_cast<std::size_t>(static_cast<int>(kMiddle + k) + shift.first)] = shift.taps[k];
    return out;
  };
  const auto filtered = [](const Response& in, const GradientTaps& taps) {
    Response out{};
    for (std::size_t k = 0; k + taps.size() <= kLength; ++k)
      for (std::size_t j = 0; j < taps.size(); ++j) out[k + j] += in[k + kGradientRadius] * taps[j];
    return out;
  };
  const auto product = [](const Response& a, const Response& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kLength; ++k) sum += a[k] * b[k];
    return sum;
  };
  const Response here = response(phase);
  const Response slope = filtered(here, gaussian_slope()), smooth = filtered(here, gaussian());
  NoiseOfPhase out;
  for (int d = -kReach; d <= kReach; ++d) {
    const auto node = static_cast<std::size_t>(d + kReach);
    const Response there = response(phase + d);
    out.slope[node] = product(slope, there);
    out.smooth[node] = product(smooth, there);
    out.same[node] = product(here, there);
    out.square[node] = product(there, there);
  }
  return out;
}

}  // namespace core
