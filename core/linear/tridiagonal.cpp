#include "core/linear/tridiagonal.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/types/constants.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kSweepsPerValue = 30;
constexpr double kClose = 1e-6;  // relative to the largest eigenvalue
constexpr int kSolves = 3;

// One implicit QL sweep over d[l..m], e2 the squared subdiagonal.
void ql_sweep(VectorXd& d, VectorXd& e2, Index l, Index m) {
  const double root = std::sqrt(e2[l]);
  const double half = (d[l + 1] - d[l]) / (2.0 * root);
  const double shift = d[l] - root / (half + std::copysign(std::hypot(half, 1.0), half));
  double c = 1.0, s = 0.0;
  double gamma = d[m] - shift;
  double p = gamma * gamma;
  for (Index i = m - 1; i >= l; --i) {
    const double b = e2[i];
    const double r = p + b;
    if (i != m - 1) e2[i + 1] = s * r;
    const double last_c = c, last_gamma = gamma;
    c = p / r;
    s = b / r;
    const double alpha = d[i];
    gamma = c * (alpha - shift) - s * last_gamma;
    d[i + 1] = last_gamma + (alpha - gamma);
    p = c != 0.0 ? gamma * gamma / c : last_c * b;
  }
  e2[l] = s * p;
  d[l] = shift + gamma;
}

// T - value I = P L U with partial pivoting, U with two superdiagonals; solved in place.
class ShiftedTridiagonal {
 public:
  explicit ShiftedTridiagonal(Index n) : inverse_(n), upper_(n), second_(n), factor_(n), swapped_(n) {}

  void factor(const VectorXd& d, const VectorXd& e, double value, double least_pivot) {
    const Index n = d.size();
    double pivot = d[0] - value;
    double right = n > 1 ? e[0] : 0.0;
    for (Index k = 0; k + 1 < n; ++k) {
      const double below = e[k];
      const double diagonal = d[k + 1] - value;
      const double beyond = k + 2 < n ? e[k + 1] : 0.0;
      swapped_[k] = std::abs(below) > std::abs(pivot);
      if (swapped_[k]) {
        inverse_[k] = 1.0 / below;
        factor_[k] = pivot * inverse_[k];
        upper_[k] = diagonal;
        second_[k] = beyond;
        pivot = right - factor_[k] * diagonal;
        right = -factor_[k] * beyond;
      } else {
        if (std::abs(pivot) < least_pivot) pivot = least_pivot;
        inverse_[k] = 1.0 / pivot;
        factor_[k] = below * inverse_[k];
        upper_[k] = right;
        second_[k] = 0.0;
        pivot = diagonal - factor_[k] * right;
        right = beyond;
      }
    }
    if (std::abs(pivot) < least_pivot) pivot = least_pivot;
    inverse_[n - 1] = 1.0 / pivot;
  }

  void solve(VectorXd& x) const {
    const Index n = x.size();
    for (Index k = 0; k + 1 < n; ++k) {
      if (swapped_[k]) std::swap(x[k], x[k + 1]);
      x[k + 1] -= factor_[k] * x[k];
    }
    x[n - 1] *= inverse_[n - 1];
    if (n > 1) x[n - 2] = (x[n - 2] - upper_[n - 2] * x[n - 1]) * inverse_[n - 2];
    for (Index k = n - 3; k >= 0; --k) x[k] = (x[k] - upper_[k] * x[k + 1] - second_[k] * x[k + 2]) * inverse_[k];
  }

 private:
  VectorXd inverse_, upper_, second_, factor_;
  Eigen::Array<bool, Eigen::Dynamic, 1> swapped_;
};

// Components of both signs and all sizes; identical in every run, different for every vector.
VectorXd start_vector(Index n, Index i_vector) {
  VectorXd x(n);
  std::uint64_t state = 0x9E3779B97F4A7C15ULL * static_cast<std::uint64_t>(i_vector + 1);
  for (double& value : x) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    value = static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
  }
  return x;
}

}  // namespace

VectorXd tridiagonal_values(const VectorXd& diagonal, const VectorXd& subdiagonal) {
  VectorXd d = diagonal;
  const Index n = d.size();
  VectorXd e2 = VectorXd::Zero(std::max<Index>(n, 1));
  if (n > 1) e2.head(n - 1) = subdiagonal.array().square();
  if (n > 1 && std::abs(d[0]) > std::abs(d[n - 1])) {  // QL converges better with the small end first
    d.reverseInPlace();
    e2.head(n - 1).reverseInPlace();
  }
  for (Index l = 0, sweeps = 0; l < n;) {
    Index m = l;
    while (m + 1 < n && e2[m] > kEpsilon * kEpsilon * std::abs(d[m] * d[m + 1])) ++m;
    if (m == l || ++sweeps > kSweepsPerValue * n) {
      ++l;
      continue;
    }
    ql_sweep(d, e2, l, m);
  }
  std::sort(d.begin(), d.end(), std::greater<>());
  return d;
}

Eigen::MatrixXd tridiagonal_vectors(const VectorXd& diagonal, const VectorXd& subdiagonal, const VectorXd& values,
                                    Index count) {
  const Index n = diagonal.size();
  Eigen::MatrixXd rows(count, n);
  Eigen::MatrixXd columns(n, count);
  const double largest = std::max(std::abs(values[0]), std::abs(values[n - 1]));
  ShiftedTridiagonal shifted(n);
  for (Index k = 0; k < count; ++k) {
    shifted.factor(diagonal, subdiagonal, values[k], std::max(kEpsilon * largest, 1e-300));
    VectorXd x = start_vector(n, k);
    for (int i_solve = 0; i_solve < kSolves; ++i_solve) {
      shifted.solve(x);
      for (Index j = k - 1; j >= 0 && values[j] - values[k] < kClose * largest; --j) {
        x -= columns.col(j).dot(x) * columns.col(j);
      }
      x *= 1.0 / x.norm();
    }
    columns.col(k) = x;
  }
  rows = columns.transpose();
  return rows;
}

}  // namespace core
