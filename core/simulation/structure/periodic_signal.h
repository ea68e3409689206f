#pragma once

#include <complex>
#include <cstddef>
#include <vector>

namespace core::simulation {

// A real signal with a finite set of harmonics of 1 / period, sampled on a fine grid and evaluated at any time by
// six-point Lagrange interpolation. A harmonic of n samples per cycle is reproduced to 0.0049 (2 pi / n)^6 of its
// amplitude: 3e-4 at 10 samples, 5e-6 at 20.
class PeriodicSignal {
 public:
  PeriodicSignal() = default;  // zero everywhere
  // x(t) = Re sum_k amplitude[k] exp(2 pi i k t / period). n_samples: a power of two above 2 * amplitude.size().
  PeriodicSignal(const std::vector<std::complex<double>>& amplitude, double period_s, std::size_t n_samples);

  [[nodiscard]] double at(double t_s) const noexcept;
  [[nodiscard]] double rms(double from_s, double to_s) const noexcept;  // over the grid samples in [from, to)
  void multiply(double factor) noexcept;

 private:
  std::vector<double> samples_;  // with 6 repeated at the end, so that a stencil never wraps
  std::size_t n_ = 0;
  double rate_hz_ = 0.0;
};

// The smallest power of two that holds period_s * rate_hz samples. Throws std::invalid_argument above 2^24.
[[nodiscard]] std::size_t grid_size(double period_s, double rate_hz);

}  // namespace core::simulation
