#pragma once

#include <array>
#include <cstddef>

namespace core {

// Interpolation by quintic B-splines (Unser, Aldroubi & Eden 1993): f(x) = sum_k beta5(x - k) c(k), where the
// coefficients c are the samples passed through a symmetric prefilter.
inline constexpr int kSplineTaps = 6;       // coefficients at -2 ... 3 about the sample below x
inline constexpr int kSplineBefore = 2;     // of which so many before that sample
inline constexpr int kPrefilterMargin = 5;  // taps on either side of the centre; omitted taps are below 0.7 %

// Two filters combined into one.
template <std::size_t kA, std::size_t kB>
[[nodiscard]] constexpr std::array<double, kA + kB - 1> joined(const std::array<double, kA>& a,
                                                               const std::array<double, kB>& b) noexcept {
  std::array<double, kA + kB - 1> taps{};
  for (std::size_t i = 0; i < kA; ++i)
    for (std::size_t k = 0; k < kB; ++k) taps[i + k] += a[i] * b[k];
  return taps;
}

// Weights of the coefficients at offsets -2 ... 3 for a position `fraction` (0 ... 1) after the sample.
[[nodiscard]] constexpr std::array<double, kSplineTaps> spline_weights(double fraction) noexcept {
  std::array<double, kSplineTaps> weights{};
  for (int k = 0; k < kSplineTaps; ++k) {
    const double from = fraction - static_cast<double>(k - kSplineBefore);
    const double x = from < 0.0 ? -from : from;
    const double rest = 3.0 - x;
    double& weight = weights[static_cast<std::size_t>(k)];
    if (x < 1.0)
      weight = 0.55 + x * x * (-0.5 + x * x * (0.25 - x / 12.0));
    else if (x < 2.0)
      weight = 0.425 + x * (0.625 + x * (-1.75 + x * (1.25 + x * (-0.375 + x / 24.0))));
    else
      weight = rest > 0.0 ? rest * rest * rest * rest * rest / 120.0 : 0.0;
  }
  return weights;
}

// Derivative at a sample, from the coefficients at -2 ... 2.
inline constexpr std::array<double, 5> kSplineSlope{-1.0 / 24.0, -10.0 / 24.0, 0.0, 10.0 / 24.0, 1.0 / 24.0};

// Converts samples to coefficients: the inverse of (1, 26, 66, 26, 1) / 120, truncated and normalised to sum 1.
// Truncated it remains symmetric: with five taps it amplifies texture by up to 5 %, with twelve by 1e-5, without a
// shift.
template <std::size_t kMargin = kPrefilterMargin>
[[nodiscard]] constexpr std::array<double, 2 * kMargin + 1> spline_prefilter() noexcept {
  constexpr std::array<double, 2> kPoles{-0.43057534709997430, -0.043096288203264652};
  constexpr int kFar = 40;
  const auto pole_response = [&](std::size_t i, int n) {
    double power = 1.0;
    for (int k = 0; k < (n < 0 ? -n : n); ++k) power *= kPoles[i];
    return -kPoles[i] / (1.0 - kPoles[i] * kPoles[i]) * power;
  };
  std::array<double, 2 * kMargin + 1> taps{};
  double sum = 0.0;
  for (int n = -static_cast<int>(kMargin); n <= static_cast<int>(kMargin); ++n) {
    double tap = 0.0;
    for (int k = -kFar; k <= kFar; ++k) tap += pole_response(0, n - k) * pole_response(1, k);
    taps[static_cast<std::size_t>(n + static_cast<int>(kMargin))] = tap;
    sum += tap;
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

}  // namespace core
