#include "core/linear/hessenberg_vector.h"

#include <algorithm>
#include <cmath>

#include "core/linear/lanes.h"
#include "core/linear/vector_clones.h"
#include "core/types/constants.h"

namespace core {

namespace linear_kernels {

// next <- below - (re + i im) current, below real.
HOVERMODAL_VECTOR_CLONES
void eliminate_kept(const double* __restrict current_re, const double* __restrict current_im,
                    const double* __restrict below, double* __restrict next_re, double* __restrict next_im, int begin,
                    int end, double re, double im) {
  for (int j = begin; j < end; ++j) {
    next_re[j] = below[j] - (re * current_re[j] - im * current_im[j]);
    next_im[j] = -(re * current_im[j] + im * current_re[j]);
  }
}

// next <- current - (re + i im) below, below real.
HOVERMODAL_VECTOR_CLONES
void eliminate_swapped(const double* __restrict current_re, const double* __restrict current_im,
                       const double* __restrict below, double* __restrict next_re, double* __restrict next_im,
                       int begin, int end, double re, double im) {
  for (int j = begin; j < end; ++j) {
    next_re[j] = current_re[j] - re * below[j];
    next_im[j] = current_im[j] - im * below[j];
  }
}

}  // namespace linear_kernels

namespace {

using Complex = std::complex<double>;

// Inner products of a row a + i b (b = 0 if absent) with x + i y.
struct RowProduct {
  int n;
  const double *a, *b, *x, *y;
  double ax = 0.0, ay = 0.0, bx = 0.0, by = 0.0;
};

constexpr int kShortLanes = 4;  // partial sums of short rows

template <int kWidth>
[[gnu::always_inline]] inline void multiply_real(const double* a, const RowProduct& p, double& ax, double& ay) {
  using Vector = typename Lanes<kWidth>::Vector;
  constexpr int kParts = kShortLanes / kWidth;
  Vector x_part[static_cast<std::size_t>(kParts)] = {}, y_part[static_cast<std::size_t>(kParts)] = {};
  int j = 0;
  for (; j + kShortLanes <= p.n; j += kShortLanes) {
    for (int h = 0; h < kParts; ++h) {
      const Vector value = *reinterpret_cast<const Vector*>(a + j + h * kWidth);
      x_part[h] += value * *reinterpret_cast<const Vector*>(p.x + j + h * kWidth);
      y_part[h] += value * *reinterpret_cast<const Vector*>(p.y + j + h * kWidth);
    }
  }
  for (; j < p.n; ++j) {
    ax += a[j] * p.x[j];
    ay += a[j] * p.y[j];
  }
  for (int lane = 0; lane < kShortLanes; ++lane) {
    ax += x_part[lane / kWidth][lane % kWidth];
    ay += y_part[lane / kWidth][lane % kWidth];
  }
}

template <int kWidth>
[[gnu::always_inline]] inline void multiply(RowProduct& p) {
  multiply_real<kWidth>(p.a, p, p.ax, p.ay);
  if (p.b != nullptr) multiply_real<kWidth>(p.b, p, p.bx, p.by);
}

void multiply_narrow(RowProduct& p) { multiply<2>(p); }
#ifdef __x86_64__
__attribute__((target("avx2"))) void multiply_wide(RowProduct& p) { multiply<4>(p); }
#else
constexpr auto multiply_wide = multiply_narrow;
#endif
const auto multiply_row = by_vector_width(multiply_narrow, multiply_wide, multiply_wide);

}  // namespace

HessenbergVector::HessenbergVector(const RowMatrix& h)
    : h_(h),
      exchanged_(static_cast<std::size_t>(h.n)),
      re_(h.values.size()),
      im_(h.values.size()),
      x_re_(static_cast<std::size_t>(h.n)),
      x_im_(x_re_) {
  for (const double value : h.values) norm_ = std::max(norm_, std::abs(value));
}

void HessenbergVector::compute(Complex lambda) {
  factor(lambda);
  substitute();
}

// Row k of U is stored in row k of re_, im_; if rows were exchanged it is row k + 1 of H - lambda I itself.
void HessenbergVector::factor(Complex lambda) {
  const int n = h_.n;
  lambda_ = lambda;
  std::copy(h_.row(0), h_.row(0) + n, re(0));
  std::fill(im(0), im(0) + n, 0.0);
  re(0)[0] -= lambda.real();
  im(0)[0] -= lambda.imag();
  for (int k = 0; k + 1 < n; ++k) {
    const double* below = h_.row(k + 1);
    const double a = re(k)[k], b = im(k)[k], size = a * a + b * b;
    const bool exchange = below[k] * below[k] > size;
    exchanged_[static_cast<std::size_t>(k)] = exchange ? 1 : 0;
    Complex diagonal = lambda;
    if (exchange) {
      const double mr = a / below[k], mi = b / below[k];
      linear_kernels::eliminate_swapped(re(k), im(k), below, re(k + 1), im(k + 1), k + 1, n, mr, mi);
      diagonal = {mi * lambda.imag() - mr * lambda.real(), -(mr * lambda.imag() + mi * lambda.real())};
    } else {
      const double factor = size > 0.0 ? below[k] / size : 0.0;
      linear_kernels::eliminate_kept(re(k), im(k), below, re(k + 1), im(k + 1), k + 1, n, factor * a, -factor * b);
    }
    re(k + 1)[k + 1] -= diagonal.real();
    im(k + 1)[k + 1] -= diagonal.imag();
  }
  exchanged_[static_cast<std::size_t>(n) - 1] = 0;
}

void HessenbergVector::substitute() {
  const double least = std::max(kEpsilon * norm_, 1e-150);
  double norm2 = 0.0;
  for (int k = h_.n - 1; k >= 0; --k) {
    const auto at = static_cast<std::size_t>(k);
    const bool exchanged = exchanged_[at] != 0;
    const Complex rest = Complex(1.0, 0.0) - (exchanged ? exchanged_product(k) : product(k));
    double a = exchanged ? h_.row(k + 1)[k] : re(k)[k];
    double b = exchanged ? 0.0 : im(k)[k];
    if (std::abs(a) + std::abs(b) < least) a = least, b = 0.0;
    const double inverse = 1.0 / (a * a + b * b);
    x_re_[at] = (rest.real() * a + rest.imag() * b) * inverse;
    x_im_[at] = (rest.imag() * a - rest.real() * b) * inverse;
    norm2 += x_re_[at] * x_re_[at] + x_im_[at] * x_im_[at];
  }
  const double scale = 1.0 / std::sqrt(norm2);
  for (double& x : x_re_) x *= scale;
  for (double& x : x_im_) x *= scale;
}

Complex HessenbergVector::product(int k) {
  RowProduct p{h_.n - k - 1, re(k) + k + 1, im(k) + k + 1, x_re_.data() + k + 1, x_im_.data() + k + 1};
  multiply_row(p);
  return {p.ax - p.by, p.ay + p.bx};
}

Complex HessenbergVector::exchanged_product(int k) {
  RowProduct p{h_.n - k - 1, h_.row(k + 1) + k + 1, nullptr, x_re_.data() + k + 1, x_im_.data() + k + 1};
  multiply_row(p);
  return Complex(p.ax, p.ay) -
         Complex(lambda_.real() * p.x[0] - lambda_.imag() * p.y[0], lambda_.real() * p.y[0] + lambda_.imag() * p.x[0]);
}

}  // namespace core
