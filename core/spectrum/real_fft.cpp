#include "core/spectrum/real_fft.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/linear/vector_clones.h"

namespace core {

namespace {

using Complex = std::complex<double>;

Complex unit_root(int k, int n) { return std::polar(1.0, -2.0 * std::numbers::pi * k / n); }

// Real and imaginary parts in separate arrays.
struct Points {
  const double *re, *im;
};

// exp(-2 pi i p / n) for one p, its square and its cube.
struct Twiddles {
  double w1r, w1i, w2r, w2i, w3r, w3i;

  Twiddles(const double* w, int n) : w1r(w[0]), w1i(w[n]), w2r(w[2 * n]), w2i(w[3 * n]), w3r(w[4 * n]), w3i(w[5 * n]) {}
};

// Reads at +0, +quarter, +2 quarter, +3 quarter; writes at +0, +step, +2 step, +3 step.
[[gnu::always_inline]] inline void butterfly(const double* __restrict fr, const double* __restrict fi,
                                             double* __restrict tr, double* __restrict ti, int quarter, int step,
                                             const Twiddles& w) {
  const double sum_r = fr[0] + fr[2 * quarter], sum_i = fi[0] + fi[2 * quarter];
  const double off_r = fr[0] - fr[2 * quarter], off_i = fi[0] - fi[2 * quarter];
  const double odd_r = fr[quarter] + fr[3 * quarter], odd_i = fi[quarter] + fi[3 * quarter];
  const double turn_r = fr[quarter] - fr[3 * quarter], turn_i = fi[quarter] - fi[3 * quarter];
  const double ar = off_r + turn_i, ai = off_i - turn_r;
  const double br = sum_r - odd_r, bi = sum_i - odd_i;
  const double cr = off_r - turn_i, ci = off_i + turn_r;
  tr[0] = sum_r + odd_r;
  ti[0] = sum_i + odd_i;
  tr[step] = w.w1r * ar - w.w1i * ai;
  ti[step] = w.w1r * ai + w.w1i * ar;
  tr[2 * step] = w.w2r * br - w.w2i * bi;
  ti[2 * step] = w.w2r * bi + w.w2i * br;
  tr[3 * step] = w.w3r * cr - w.w3i * ci;
  ti[3 * step] = w.w3r * ci + w.w3i * cr;
}

// `count` adjacent butterflies with one set of twiddles.
[[gnu::always_inline]] inline void butterflies(const double* __restrict fr, const double* __restrict fi,
                                               double* __restrict tr, double* __restrict ti, int quarter, int count,
                                               const Twiddles& w) {
  for (int q = 0; q < count; ++q) butterfly(fr + q, fi + q, tr + q, ti + q, quarter, count, w);
}

}  // namespace

namespace fft_kernels {

// Stride 1: every butterfly has its own twiddles.
HOVERMODAL_VECTOR_CLONES
void first_pass(const double* __restrict fr, const double* __restrict fi, double* __restrict tr, double* __restrict ti,
                int quarter, const double* __restrict w) {
  for (int p = 0; p < quarter; ++p) {
    butterfly(fr + p, fi + p, tr + 4 * p, ti + 4 * p, quarter, 1, Twiddles(w + p, quarter));
  }
}

HOVERMODAL_VECTOR_CLONES
void pass_of_four(const double* __restrict fr, const double* __restrict fi, double* __restrict tr,
                  double* __restrict ti, int n_butterflies, int stride, const double* w) {
  const int quarter = n_butterflies * stride;
  for (int p = 0; p < n_butterflies; ++p) {
    const int from = p * stride, to = 4 * p * stride;
    const Twiddles twiddles(w + p, n_butterflies);
    if (stride == 4) {
      butterflies(fr + from, fi + from, tr + to, ti + to, quarter, 4, twiddles);
    } else {
      butterflies(fr + from, fi + from, tr + to, ti + to, quarter, stride, twiddles);
    }
  }
}

HOVERMODAL_VECTOR_CLONES
void pass_of_two(const double* __restrict fr, const double* __restrict fi, double* __restrict tr, double* __restrict ti,
                 int stride) {
  for (int q = 0; q < stride; ++q) {
    tr[q] = fr[q] + fr[q + stride];
    ti[q] = fi[q] + fi[q + stride];
    tr[q + stride] = fr[q] - fr[q + stride];
    ti[q + stride] = fi[q] - fi[q + stride];
  }
}

// Spectrum of x from the transform z of x[2 k] + i x[2 k + 1], k = 1 .. half - 1.
HOVERMODAL_VECTOR_CLONES
void untangle(const double* __restrict re, const double* __restrict im, Points unit, int half,
              double* __restrict spectrum) {
  for (int k = 1; k < half; ++k) {
    const double even_r = 0.5 * (re[k] + re[half - k]), even_i = 0.5 * (im[k] - im[half - k]);
    const double odd_r = 0.5 * (im[k] + im[half - k]), odd_i = -0.5 * (re[k] - re[half - k]);
    spectrum[2 * k] = even_r + (unit.re[k] * odd_r - unit.im[k] * odd_i);
    spectrum[2 * k + 1] = even_i + (unit.re[k] * odd_i + unit.im[k] * odd_r);
  }
}

// Its inverse, conjugated: the inverse is the forward transform between two conjugations. k = 0 .. half - 1.
HOVERMODAL_VECTOR_CLONES
void tangle(const double* __restrict spectrum, Points unit, int half, double* __restrict re, double* __restrict im) {
  for (int k = 0; k < half; ++k) {
    const double ar = spectrum[2 * k], ai = spectrum[2 * k + 1];
    const double br = spectrum[2 * (half - k)], bi = -spectrum[2 * (half - k) + 1];
    const double off_r = 0.5 * (ar - br), off_i = 0.5 * (ai - bi);
    const double odd_r = unit.re[k] * off_r + unit.im[k] * off_i, odd_i = unit.re[k] * off_i - unit.im[k] * off_r;
    re[k] = 0.5 * (ar + br) - odd_i;
    im[k] = -(0.5 * (ai + bi) + odd_r);
  }
}

}  // namespace fft_kernels

int next_power_of_two(int n) noexcept {
  int power = 1;
  while (power < n) power *= 2;
  return power;
}

RealFft::RealFft(int n) : n_(n), half_(n / 2) {
  if (n < 4 || (n & (n - 1)) != 0)
    throw std::invalid_argument("RealFft: length " + std::to_string(n) + " is not a power of two >= 4");
  int n_points = half_;
  for (int stride = 1; n_points >= 4; n_points /= 4, stride *= 4) {
    Pass pass{n_points / 4, stride, {}};
    for (int power = 1; power <= 3; ++power) {
      for (const bool imaginary : {false, true}) {
        for (int p = 0; p < pass.n_butterflies; ++p) {
          const Complex w = unit_root(power * p, n_points);
          pass.twiddles.push_back(imaginary ? w.imag() : w.real());
        }
      }
    }
    passes_.push_back(std::move(pass));
  }
  radix_two_last_ = n_points == 2;
  for (int k = 0; k <= half_; ++k) {
    unit_re_.push_back(unit_root(k, n_).real());
    unit_im_.push_back(unit_root(k, n_).imag());
  }
  for (std::vector<double>* points : {&re_, &im_, &re_to_, &im_to_})
    points->assign(static_cast<std::size_t>(half_), 0.0);
}

void RealFft::transform_half() noexcept {
  const auto swap = [this]() noexcept {
    std::swap(re_, re_to_);
    std::swap(im_, im_to_);
  };
  for (const Pass& pass : passes_) {
    if (pass.stride == 1) {
      fft_kernels::first_pass(re_.data(), im_.data(), re_to_.data(), im_to_.data(), pass.n_butterflies,
                              pass.twiddles.data());
    } else {
      fft_kernels::pass_of_four(re_.data(), im_.data(), re_to_.data(), im_to_.data(), pass.n_butterflies, pass.stride,
                                pass.twiddles.data());
    }
    swap();
  }
  if (!radix_two_last_) return;
  fft_kernels::pass_of_two(re_.data(), im_.data(), re_to_.data(), im_to_.data(), half_ / 2);
  swap();
}

void RealFft::forward(std::span<const double> x, std::span<Complex> spectrum) noexcept {
  assert(x.size() == static_cast<std::size_t>(n_) && spectrum.size() == static_cast<std::size_t>(n_bins()));
  const auto half = static_cast<std::size_t>(half_);
  for (std::size_t k = 0; k < half; ++k) {
    re_[k] = x[2 * k];
    im_[k] = x[2 * k + 1];
  }
  transform_half();
  spectrum[0] = re_[0] + im_[0];
  spectrum[half] = re_[0] - im_[0];
  // std::complex<double> has the layout of two doubles ([complex.numbers.general]).
  fft_kernels::untangle(re_.data(), im_.data(), {unit_re_.data(), unit_im_.data()}, half_,
                        reinterpret_cast<double*>(spectrum.data()));
}

void RealFft::inverse(std::span<const Complex> spectrum, std::span<double> x) noexcept {
  assert(x.size() == static_cast<std::size_t>(n_) && spectrum.size() == static_cast<std::size_t>(n_bins()));
  fft_kernels::tangle(reinterpret_cast<const double*>(spectrum.data()), {unit_re_.data(), unit_im_.data()}, half_,
                      re_.data(), im_.data());
  transform_half();
  const double scale = 1.0 / half_;
  for (std::size_t k = 0; k < static_cast<std::size_t>(half_); ++k) {
    x[2 * k] = re_[k] * scale;
    x[2 * k + 1] = -im_[k] * scale;
  }
}

}  // namespace core
