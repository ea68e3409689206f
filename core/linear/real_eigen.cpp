#include "core/linear/real_eigen.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/linear/francis_qr.h"
#include "core/linear/lanes.h"
#include "core/linear/vector_clones.h"

namespace core {

namespace {

using Complex = std::complex<double>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct RightReflection {
  double* rows;
  int stride, n_rows, n_columns;
  const double* v;
  double tau;
};

// rows <- rows (I - tau v v^T).
template <int kWidth>
[[gnu::always_inline]] inline void reflect_from_right(const RightReflection& r) {
  using Vector = typename Lanes<kWidth>::Vector;
  constexpr int kParts = kLanes / kWidth;
  for (int i = 0; i < r.n_rows; ++i) {
    double* row = r.rows + static_cast<std::ptrdiff_t>(i) * r.stride;
    Vector part[static_cast<std::size_t>(kParts)] = {};
    int j = 0;
    for (; j + kLanes <= r.n_columns; j += kLanes) {
      for (int h = 0; h < kParts; ++h) {
        part[h] += *reinterpret_cast<const Vector*>(row + j + h * kWidth) *
                   *reinterpret_cast<const Vector*>(r.v + j + h * kWidth);
      }
    }
    double sum = 0.0;
    for (; j < r.n_columns; ++j) sum += row[j] * r.v[j];
    for (int lane = 0; lane < kLanes; ++lane) sum += part[lane / kWidth][lane % kWidth];
    const double factor = r.tau * sum;
    for (j = 0; j + kLanes <= r.n_columns; j += kLanes) {
      for (int h = 0; h < kParts; ++h) {
        *reinterpret_cast<Vector*>(row + j + h * kWidth) -=
            factor * *reinterpret_cast<const Vector*>(r.v + j + h * kWidth);
      }
    }
    for (; j < r.n_columns; ++j) row[j] -= factor * r.v[j];
  }
}

void reflect_narrow(const RightReflection& r) { reflect_from_right<2>(r); }
#ifdef __x86_64__
__attribute__((target("avx2"))) void reflect_wide(const RightReflection& r) { reflect_from_right<4>(r); }
__attribute__((target("avx512f"))) void reflect_widest(const RightReflection& r) { reflect_from_right<8>(r); }
#else
constexpr auto reflect_wide = reflect_narrow;
constexpr auto reflect_widest = reflect_narrow;
#endif
const auto reflect_rows_from_right = by_vector_width(reflect_narrow, reflect_wide, reflect_widest);

}  // namespace

namespace linear_kernels {

// sum[j] = sum_i v[i] rows(i, j), then rows(i, j) -= tau v[i] sum[j].
HOVERMODAL_VECTOR_CLONES
void reflect_from_left(double* rows, int stride, int n_rows, int n_columns, const double* v, double tau,
                       double* __restrict sum) {
  for (int j = 0; j < n_columns; ++j) sum[j] = 0.0;
  for (int i = 0; i < n_rows; ++i) {
    const double* __restrict row = rows + static_cast<std::ptrdiff_t>(i) * stride;
    const double factor = v[i];
    for (int j = 0; j < n_columns; ++j) sum[j] += factor * row[j];
  }
  for (int i = 0; i < n_rows; ++i) {
    double* __restrict row = rows + static_cast<std::ptrdiff_t>(i) * stride;
    const double factor = tau * v[i];
    for (int j = 0; j < n_columns; ++j) row[j] -= factor * sum[j];
  }
}

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

// Q^T A Q = H in place, C <- C Q.
void to_hessenberg(RowMatrix& a, std::vector<double>& c, int n_seen) {
  const int n = a.n;
  std::vector<double> v(static_cast<std::size_t>(n)), sum(static_cast<std::size_t>(n));
  for (int k = 0; k + 2 < n; ++k) {
    const int m = n - k - 1;
    double rest = 0.0;
    for (int i = 0; i < m; ++i) {
      v[static_cast<std::size_t>(i)] = a.row(k + 1 + i)[k];
      if (i > 0) rest += v[static_cast<std::size_t>(i)] * v[static_cast<std::size_t>(i)];
    }
    if (rest == 0.0) continue;
    const double first = v[0];
    const double beta = -std::copysign(std::sqrt(first * first + rest), first);
    const double scale = 1.0 / (first - beta);
    for (double& x : v) x *= scale;
    v[0] = 1.0;
    const double tau = (beta - first) / beta;
    linear_kernels::reflect_from_left(a.row(k + 1) + k + 1, n, m, m, v.data(), tau, sum.data());
    reflect_rows_from_right({a.row(0) + k + 1, n, n, m, v.data(), tau});
    reflect_rows_from_right({c.data() + k + 1, n, n_seen, m, v.data(), tau});
    a.row(k + 1)[k] = beta;
    for (int i = k + 2; i < n; ++i) a.row(i)[k] = 0.0;
  }
}

// Eigenvectors of an upper Hessenberg matrix: with H - lambda I = P L U, solves U x = L^-1 P^T b for a b chosen so that
// the right side is a vector of ones.
class HessenbergVector {
 public:
  explicit HessenbergVector(const RowMatrix& h)
      : h_(h),
        exchanged_(static_cast<std::size_t>(h.n)),
        re_(h.values.size()),
        im_(h.values.size()),
        x_re_(static_cast<std::size_t>(h.n)),
        x_im_(x_re_) {
    for (const double value : h.values) norm_ = std::max(norm_, std::abs(value));
  }

  void compute(Complex lambda) {
    factor(lambda);
    substitute();
  }
  [[nodiscard]] const std::vector<double>& re() const noexcept { return x_re_; }  // of unit norm
  [[nodiscard]] const std::vector<double>& im() const noexcept { return x_im_; }

 private:
  double* re(int i) { return re_.data() + static_cast<std::ptrdiff_t>(i) * h_.n; }
  double* im(int i) { return im_.data() + static_cast<std::ptrdiff_t>(i) * h_.n; }

  // Row k of U stands in row k of re_, im_; where rows were exchanged it is row k + 1 of H - lambda I itself.
  void factor(Complex lambda) {
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

  void substitute() {
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

  // sum over j > k of U(k, j) x(j).
  [[nodiscard]] Complex product(int k) {
    const double *a = re(k), *b = im(k), *x = x_re_.data(), *y = x_im_.data();
    double ax0 = 0.0, by0 = 0.0, ay0 = 0.0, bx0 = 0.0, ax1 = 0.0, by1 = 0.0, ay1 = 0.0, bx1 = 0.0;
    int j = k + 1;
    for (; j + 2 <= h_.n; j += 2) {
      ax0 += a[j] * x[j];
      by0 += b[j] * y[j];
      ay0 += a[j] * y[j];
      bx0 += b[j] * x[j];
      ax1 += a[j + 1] * x[j + 1];
      by1 += b[j + 1] * y[j + 1];
      ay1 += a[j + 1] * y[j + 1];
      bx1 += b[j + 1] * x[j + 1];
    }
    if (j < h_.n) {
      ax0 += a[j] * x[j];
      by0 += b[j] * y[j];
      ay0 += a[j] * y[j];
      bx0 += b[j] * x[j];
    }
    return {(ax0 + ax1) - (by0 + by1), (ay0 + ay1) + (bx0 + bx1)};
  }

  [[nodiscard]] Complex exchanged_product(int k) {
    const double *a = h_.row(k + 1), *x = x_re_.data(), *y = x_im_.data();
    double ax0 = 0.0, ay0 = 0.0, ax1 = 0.0, ay1 = 0.0;
    int j = k + 1;
    for (; j + 2 <= h_.n; j += 2) {
      ax0 += a[j] * x[j];
      ay0 += a[j] * y[j];
      ax1 += a[j + 1] * x[j + 1];
      ay1 += a[j + 1] * y[j + 1];
    }
    if (j < h_.n) {
      ax0 += a[j] * x[j];
      ay0 += a[j] * y[j];
    }
    const double u = x[k + 1], v = y[k + 1];
    return {(ax0 + ax1) - (lambda_.real() * u - lambda_.imag() * v),
            (ay0 + ay1) - (lambda_.real() * v + lambda_.imag() * u)};
  }

  const RowMatrix& h_;
  double norm_ = 0.0;
  Complex lambda_;
  std::vector<std::uint8_t> exchanged_;
  std::vector<double> re_, im_, x_re_, x_im_;
};

}  // namespace

bool upper_half_plane_eigen(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& c,
                            UpperEigen& out) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  out = {};
  const auto n = static_cast<int>(a.rows());
  const auto n_seen = static_cast<int>(c.rows());
  RowMatrix h{n, std::vector<double>(static_cast<std::size_t>(a.size()))};
  std::vector<double> seen(static_cast<std::size_t>(c.size()));
  Eigen::Map<RowMajor>(h.values.data(), n, n) = a;
  Eigen::Map<RowMajor>(seen.data(), n_seen, n) = c;
  to_hessenberg(h, seen, n_seen);

  RowMatrix worked = h;
  std::vector<Complex> values;
  if (!hessenberg_values(worked, values)) return false;
  std::copy_if(values.begin(), values.end(), std::back_inserter(out.values),
               [](Complex value) { return value.imag() > 0.0; });
  out.seen.resize(n_seen, static_cast<Eigen::Index>(out.values.size()));
  HessenbergVector vector(h);
  for (std::size_t k = 0; k < out.values.size(); ++k) {
    vector.compute(out.values[k]);
    for (int i = 0; i < n_seen; ++i) {
      const double* row = seen.data() + static_cast<std::ptrdiff_t>(i) * n;
      double re = 0.0, im = 0.0;
      for (int j = 0; j < n; ++j) {
        re += row[j] * vector.re()[static_cast<std::size_t>(j)];
        im += row[j] * vector.im()[static_cast<std::size_t>(j)];
      }
      out.seen(i, static_cast<Eigen::Index>(k)) = {re, im};
    }
  }
  return true;
}

}  // namespace core
