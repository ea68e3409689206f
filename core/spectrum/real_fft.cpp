#include "core/spectrum/real_fft.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

namespace core {

namespace {

using Complex = std::complex<double>;

// std::complex's operator* checks for NaN and infinity as C's Annex G asks, which costs more than the product.
inline Complex multiply(Complex a, Complex b) noexcept {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

Complex unit_root(int k, int n) { return std::polar(1.0, -2.0 * std::numbers::pi * k / n); }

}  // namespace

int next_power_of_two(int n) noexcept {
  int power = 1;
  while (power < n) power *= 2;
  return power;
}

RealFft::RealFft(int n) : n_(n), half_(n / 2) {
  if (n < 4 || (n & (n - 1)) != 0)
    throw std::invalid_argument("RealFft: length " + std::to_string(n) + " is not a power of two >= 4");
  const auto half = static_cast<std::size_t>(half_);
  for (int k = 0; k < half_ / 2; ++k) twiddle_half_.push_back(unit_root(k, half_));
  for (int k = 0; k <= half_; ++k) twiddle_full_.push_back(unit_root(k, n_));
  work_.resize(half);
  bit_reversed_.assign(half, 0);
  for (std::size_t i = 1, j = 0; i < half; ++i) {
    std::size_t bit = half >> 1;
    for (; (j & bit) != 0; bit >>= 1) j ^= bit;
    j ^= bit;
    bit_reversed_[i] = static_cast<int>(j);
  }
}

void RealFft::transform_half() noexcept {
  const auto half = static_cast<std::size_t>(half_);
  for (std::size_t i = 0; i < half; ++i) {
    const auto j = static_cast<std::size_t>(bit_reversed_[i]);
    if (i < j) std::swap(work_[i], work_[j]);
  }
  for (std::size_t length = 2; length <= half; length *= 2) {
    const std::size_t step = half / length;
    for (std::size_t begin = 0; begin < half; begin += length) {
      for (std::size_t k = 0; k < length / 2; ++k) {
        const Complex even = work_[begin + k];
        const Complex odd = multiply(work_[begin + k + length / 2], twiddle_half_[k * step]);
        work_[begin + k] = even + odd;
        work_[begin + k + length / 2] = even - odd;
      }
    }
  }
}

void RealFft::forward(std::span<const double> x, std::span<Complex> spectrum) noexcept {
  assert(x.size() == static_cast<std::size_t>(n_) && spectrum.size() == static_cast<std::size_t>(n_bins()));
  const auto half = static_cast<std::size_t>(half_);
  for (std::size_t k = 0; k < half; ++k) work_[k] = {x[2 * k], x[2 * k + 1]};
  transform_half();
  for (std::size_t k = 0; k <= half; ++k) {
    const Complex a = work_[k % half];
    const Complex b = std::conj(work_[(half - k) % half]);
    const Complex even = 0.5 * (a + b);
    const Complex odd = multiply(Complex(0.0, -0.5), a - b);
    spectrum[k] = even + multiply(twiddle_full_[k], odd);
  }
}

void RealFft::inverse(std::span<const Complex> spectrum, std::span<double> x) noexcept {
  assert(x.size() == static_cast<std::size_t>(n_) && spectrum.size() == static_cast<std::size_t>(n_bins()));
  const auto half = static_cast<std::size_t>(half_);
  for (std::size_t k = 0; k < half; ++k) {
    const Complex a = spectrum[k];
    const Complex b = std::conj(spectrum[half - k]);
    const Complex even = 0.5 * (a + b);
    const Complex odd = multiply(std::conj(twiddle_full_[k]), 0.5 * (a - b));
    // Conjugated, because the inverse is the forward transform between two conjugations.
    work_[k] = std::conj(even + multiply(Complex(0.0, 1.0), odd));
  }
  transform_half();
  const double scale = 1.0 / half_;
  for (std::size_t k = 0; k < half; ++k) {
    x[2 * k] = work_[k].real() * scale;
    x[2 * k + 1] = -work_[k].imag() * scale;
  }
}

}  // namespace core
