#include "core/simulation/structure/periodic_signal.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace core::simulation {
namespace {

using Complex = std::complex<double>;
constexpr std::size_t kStencil = 6;

// exp(2 pi i k / (2 h)) for k < h at h + k, h = 1, 2, 4, ..: each stage of the transform reads its own in order.
std::vector<Complex> roots(std::size_t n) {
  std::vector<Complex> root(n);
  for (std::size_t k = 0; k < n / 2; ++k) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n);
    root[n / 2 + k] = {std::cos(angle), std::sin(angle)};
  }
  for (std::size_t h = n / 4; h >= 1; h /= 2) {
    for (std::size_t k = 0; k < h; ++k) root[h + k] = root[2 * h + 2 * k];
  }
  return root;
}

// Input: bit-reversed z. Recurses into halves first, so that small transforms are completed in the cache.
void butterflies(Complex* z, std::size_t n, const Complex* root) {
  if (n < 2) return;
  const std::size_t half = n / 2;
  butterflies(z, half, root);
  butterflies(z + half, half, root);
  for (std::size_t k = 0; k < half; ++k) {
    const Complex w = root[half + k], a = z[k], b = z[half + k];
    const Complex product{w.real() * b.real() - w.imag() * b.imag(), w.real() * b.imag() + w.imag() * b.real()};
    z[k] = a + product;
    z[half + k] = a - product;
  }
}

// In place, unscaled, kernel exp(+2 pi i k n / N); N a power of two.
void inverse_fft(std::vector<Complex>& z, const std::vector<Complex>& root) {
  const std::size_t n = z.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(z[i], z[j]);
  }
  butterflies(z.data(), n, root.data());
}

}  // namespace

std::size_t grid_size(double period_s, double rate_hz) {
  const double wanted = std::ceil(period_s * rate_hz);
  if (!(wanted <= 0x1.0p24)) {
    throw std::invalid_argument("simulation of " + std::to_string(period_s) +
                                " s needs more than 2^24 grid samples: shorten the duration");
  }
  std::size_t n = 16;
  while (static_cast<double>(n) < wanted) n *= 2;
  return n;
}

PeriodicSignal::PeriodicSignal(const std::vector<Complex>& amplitude, double period_s, std::size_t n_samples)
    : n_(n_samples), rate_hz_(static_cast<double>(n_samples) / period_s) {
  if (2 * amplitude.size() > n_samples)
    throw std::invalid_argument("PeriodicSignal: grid too coarse for its harmonics");
  // Even and odd samples as real and imaginary part of a transform of half the length (Press et al., Numerical Recipes,
  // 12.3): z[k] = (x[k] + x[k + n/2]) + i exp(2 pi i k / n) (x[k] - x[k + n/2]), x[k] = conj(x[n - k]) = amplitude[k]
  // / 2.
  const std::size_t half = n_samples / 2;
  const std::vector<Complex> root = roots(n_samples);
  const auto x = [&](std::size_t k) { return k < amplitude.size() ? 0.5 * amplitude[k] : Complex(0.0); };
  std::vector<Complex> z(half);
  for (std::size_t k = 0; k < half; ++k) {
    const Complex low = k == 0 ? Complex(2.0 * x(0).real(), 0.0) : x(k), high = std::conj(x(half - k));
    z[k] = (low + high) + Complex(0.0, 1.0) * root[half + k] * (low - high);
  }
  inverse_fft(z, root);
  samples_.resize(n_samples + kStencil);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const Complex& pair = z[(i % n_samples) / 2];
    samples_[i] = i % 2 == 0 ? pair.real() : pair.imag();
  }
}

double PeriodicSignal::at(double t_s) const noexcept {
  if (n_ == 0) return 0.0;
  const double n = static_cast<double>(n_);
  double position = t_s * rate_hz_;
  position -= n * std::floor(position / n);
  const double cell = std::floor(position);
  const double x = position - cell;
  // The stencil covers cells -2 .. +3 around `cell`; starting two early keeps the point in its middle.
  const std::size_t first = (static_cast<std::size_t>(cell) + n_ - 2) % n_;
  const double a = x + 2.0, b = x + 1.0, c = x, d = x - 1.0, e = x - 2.0, f = x - 3.0;
  const double* s = samples_.data() + first;
  return s[0] * (b * c * d * e * f) / -120.0 + s[1] * (a * c * d * e * f) / 24.0 + s[2] * (a * b * d * e * f) / -12.0 +
         s[3] * (a * b * c * e * f) / 12.0 + s[4] * (a * b * c * d * f) / -24.0 + s[5] * (a * b * c * d * e) / 120.0;
}

double PeriodicSignal::rms(double from_s, double to_s) const noexcept {
  if (n_ == 0) return 0.0;
  const auto first = static_cast<std::size_t>(std::ceil(from_s * rate_hz_));
  const auto last = static_cast<std::size_t>(std::ceil(to_s * rate_hz_));
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) sum += samples_[i % n_] * samples_[i % n_];
  return last > first ? std::sqrt(sum / static_cast<double>(last - first)) : std::abs(at(from_s));
}

void PeriodicSignal::multiply(double factor) noexcept {
  for (double& s : samples_) s *= factor;
}

}  // namespace core::simulation
