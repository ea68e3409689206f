#include "core/linear/symmetric_eigen.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "core/linear/dense.h"
#include "core/linear/lanes.h"
#include "core/linear/tridiagonal.h"
#include "core/linear/vector_clones.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostOblique = 1e-8;
constexpr Index kGroup = 4;  // columns per sweep

// Pointers to the trailing part of size m.
struct Sweep {
  double* a;
  Index lda, m;
  const double *last_v, *last_w;  // pending rank-two update of the trailing part
  const double* v;
  double* y;  // a v
};

// One column, rows first .. end.
[[gnu::always_inline]] inline void sweep_column(const Sweep& s, Index j, Index end) {
  double* column = s.a + j * s.lda;
  const double v = s.last_v[j], w = s.last_w[j];
  column[j] -= s.last_v[j] * w + s.last_w[j] * v;
  s.y[j] += column[j] * s.v[j];
  for (Index i = j + 1; i < end; ++i) {
    column[i] -= s.last_v[i] * w + s.last_w[i] * v;
    s.y[i] += column[i] * s.v[j];
    s.y[j] += column[i] * s.v[i];
  }
}

// Four columns, from the row below their triangle on. An inner product is kLanes partial sums and a remainder, whatever
// the machine's vector width.
template <int kWidth>
[[gnu::always_inline]] inline void sweep_group(const Sweep& s, Index j) {
  using Vector = typename Lanes<kWidth>::Vector;
  constexpr std::size_t kParts = kLanes / kWidth;
  double* column[kGroup];
  double sum[kGroup] = {};
  Vector part[kGroup][kParts];
  for (int t = 0; t < kGroup; ++t) {
    column[t] = s.a + (j + t) * s.lda;
    for (std::size_t h = 0; h < kParts; ++h) part[t][h] = Vector{} * 0.0;
  }
  Index i = j + kGroup;
  for (; i + kLanes <= s.m; i += kLanes) {
    for (std::size_t h = 0; h < kParts; ++h) {
      const Index at = i + static_cast<Index>(h) * kWidth;
      const Vector last_v = *reinterpret_cast<const Vector*>(s.last_v + at);
      const Vector last_w = *reinterpret_cast<const Vector*>(s.last_w + at);
      const Vector v = *reinterpret_cast<const Vector*>(s.v + at);
      Vector y = *reinterpret_cast<const Vector*>(s.y + at);
      for (int t = 0; t < kGroup; ++t) {
        Vector& place = *reinterpret_cast<Vector*>(column[t] + at);
        const Vector a = place - (last_v * s.last_w[j + t] + last_w * s.last_v[j + t]);
        place = a;
        y += a * s.v[j + t];
        part[t][h] += a * v;
      }
      *reinterpret_cast<Vector*>(s.y + at) = y;
    }
  }
  for (; i < s.m; ++i) {
    for (int t = 0; t < kGroup; ++t) {
      column[t][i] -= s.last_v[i] * s.last_w[j + t] + s.last_w[i] * s.last_v[j + t];
      s.y[i] += column[t][i] * s.v[j + t];
      sum[t] += column[t][i] * s.v[i];
    }
  }
  for (int t = 0; t < kGroup; ++t) {
    for (int lane = 0; lane < kLanes; ++lane) sum[t] += part[t][lane / kWidth][lane % kWidth];
    s.y[j + t] += sum[t];
  }
}

template <int kWidth>
[[gnu::always_inline]] inline void sweep(const Sweep& s) {
  for (Index i = 0; i < s.m; ++i) s.y[i] = 0.0;
  Index j = 0;
  for (; j + kGroup <= s.m; j += kGroup) {
    for (Index t = 0; t < kGroup; ++t) sweep_column(s, j + t, j + kGroup);
    sweep_group<kWidth>(s, j);
  }
  for (; j < s.m; ++j) sweep_column(s, j, s.m);
}

void sweep_narrow(const Sweep& s) { sweep<2>(s); }

#ifdef __x86_64__
__attribute__((target("avx2"))) void sweep_wide(const Sweep& s) { sweep<4>(s); }
__attribute__((target("avx512f"))) void sweep_widest(const Sweep& s) { sweep<8>(s); }
#else
constexpr auto sweep_wide = sweep_narrow;
constexpr auto sweep_widest = sweep_narrow;
#endif
const auto sweep_trailing = by_vector_width(sweep_narrow, sweep_wide, sweep_widest);

// Replaces x by v with v[0] = 1; returns tau of I - tau v v^T, and in `beta` the transformed x[0].
double make_reflector(Eigen::Ref<VectorXd> x, double& beta) {
  double rest = 0.0;
  for (Index i = 1; i < x.size(); ++i) rest += x[i] * x[i];
  const double first = x[0];
  x[0] = 1.0;
  beta = first;
  if (rest == 0.0) return 0.0;
  beta = -std::copysign(std::sqrt(first * first + rest), first);
  x.tail(x.size() - 1) *= 1.0 / (first - beta);
  return (beta - first) / beta;
}

}  // namespace

namespace linear_kernels {

// rows <- rows (I - tau v v^T); rows: count x m, column-major; product: room for count.
HOVERMODAL_VECTOR_CLONES
void reflect_rows(double* rows, Index count, Index m, const double* v, double tau, double* __restrict product) {
  for (Index i = 0; i < count; ++i) product[i] = 0.0;
  Index k = 0;
  for (; k + 4 <= m; k += 4) {
    const double* __restrict r = rows + k * count;
    const double v0 = v[k], v1 = v[k + 1], v2 = v[k + 2], v3 = v[k + 3];
    for (Index i = 0; i < count; ++i) {
      product[i] = (((product[i] + r[i] * v0) + r[i + count] * v1) + r[i + 2 * count] * v2) + r[i + 3 * count] * v3;
    }
  }
  for (; k < m; ++k) {
    for (Index i = 0; i < count; ++i) product[i] += rows[i + k * count] * v[k];
  }
  for (Index j = 0; j < m; ++j) {
    double* __restrict r = rows + j * count;
    const double factor = tau * v[j];
    for (Index i = 0; i < count; ++i) r[i] -= product[i] * factor;
  }
}

}  // namespace linear_kernels

SymmetricEigen::SymmetricEigen(MatrixXd a) : reflectors_(std::move(a)) {
  const Index n = reflectors_.rows();
  tau_ = VectorXd::Zero(n);
  diagonal_ = reflectors_.diagonal();
  subdiagonal_ = VectorXd::Zero(std::max<Index>(n - 1, 0));
  reduce();
  values_ = tridiagonal_values(diagonal_, subdiagonal_);
}

void SymmetricEigen::reduce() {
  const Index n = reflectors_.rows();
  MatrixXd& a = reflectors_;
  VectorXd last_v = VectorXd::Zero(n), last_w = VectorXd::Zero(n), y = VectorXd::Zero(n);
  const auto finish_column = [&](Index k) {
    a.col(k).tail(n - k) -= last_v.tail(n - k) * last_w[k] + last_w.tail(n - k) * last_v[k];
    diagonal_[k] = a(k, k);
  };
  for (Index k = 0; k + 2 < n; ++k) {
    finish_column(k);
    const Index m = n - k - 1;
    auto v = a.col(k).tail(m);
    tau_[k] = make_reflector(v, subdiagonal_[k]);
    sweep_trailing({&a(k + 1, k + 1), n, m, &last_v[k + 1], &last_w[k + 1], v.data(), &y[k + 1]});
    auto w = y.tail(m);
    w *= tau_[k];
    double inner = 0.0;
    for (Index i = 0; i < m; ++i) inner += w[i] * v[i];
    w -= (0.5 * tau_[k] * inner) * v;
    last_v.tail(m) = v;
    last_w.tail(m) = w;
  }
  for (Index k = std::max<Index>(n - 2, 0); k < n; ++k) {
    finish_column(k);
    if (k + 1 < n) subdiagonal_[k] = a(k + 1, k);
  }
}

MatrixXd SymmetricEigen::leading_vectors(Index count) const {
  const Index n = reflectors_.rows();
  MatrixXd rows = tridiagonal_vectors(diagonal_, subdiagonal_, values_, count);
  MatrixXd oblique = -MatrixXd::Identity(count, count);
  add_product_transposed(oblique, 1.0, rows, rows);
  VectorXd product(count);
  if (!(oblique.cwiseAbs().maxCoeff() < kMostOblique)) {
    Eigen::SelfAdjointEigenSolver<MatrixXd> whole;
    whole.computeFromTridiagonal(diagonal_, subdiagonal_);
    rows = whole.eigenvectors().rowwise().reverse().leftCols(count).transpose();
  }
  for (Index k = n - 3; k >= 0; --k) {
    linear_kernels::reflect_rows(rows.data() + (k + 1) * count, count, n - k - 1, &reflectors_(k + 1, k), tau_[k],
                                 product.data());
  }
  return rows.transpose();
}

}  // namespace core
