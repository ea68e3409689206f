#pragma once

#include <cmath>
#include <complex>
#include <cstdint>

#include "core/types/constants.h"

namespace core {

inline constexpr int kLineReach = 32;  // bins to either side of a line beyond which its sidelobes are neglected

// Transform of the window at `off_hz` from the frequency of a line with amplitude 1, from the segment's first sample.
class LineTransform {
 public:
  LineTransform(double window_a0, double rate_hz) : a0_(window_a0), rate_hz_(rate_hz) {}

  [[nodiscard]] std::complex<double> at(double off_hz, std::uint64_t n_samples) const {
    const double n = static_cast<double>(n_samples), turns = off_hz / rate_hz_;
    return a0_ * sum(turns, n) - 0.5 * (1.0 - a0_) * (sum(turns + 1.0 / n, n) + sum(turns - 1.0 / n, n));
  }

 private:
  // Of exp(2 pi i turns t), t = 0 ... n - 1.
  static std::complex<double> sum(double turns, double n) {
    const double half = std::sin(0.5 * kTwoPi * turns);
    if (std::abs(half) < 1e-12) return n;
    return std::polar(std::sin(0.5 * kTwoPi * turns * n) / half, 0.5 * kTwoPi * turns * (n - 1.0));
  }

  double a0_, rate_hz_;
};

}  // namespace core
