#include "core/linear/real_eigen.h"

#include <algorithm>
#include <cmath>

#include "core/linear/francis_qr.h"
#include "core/linear/hessenberg_vector.h"
#include "core/linear/lanes.h"
#include "core/linear/vector_clones.h"

namespace core {

namespace {

using Complex = std::complex<double>;

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
  const Eigen::MatrixXd by_vector = Eigen::Map<RowMajor>(seen.data(), n_seen, n);
  for (std::size_t k = 0; k < out.values.size(); ++k) {
    vector.compute(out.values[k]);
    const auto column = static_cast<Eigen::Index>(k);
    out.seen.col(column).real() = by_vector * Eigen::Map<const Eigen::VectorXd>(vector.re().data(), n);
    out.seen.col(column).imag() = by_vector * Eigen::Map<const Eigen::VectorXd>(vector.im().data(), n);
  }
  return true;
}

}  // namespace core
