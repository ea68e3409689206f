#include "core/structure/dense_modes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/linear/symmetric_eigen.h"

namespace core::structure {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLeastPivot = 1e-13;  // of the matrix scaled to a unit diagonal; rounding leaves about 1e-15

// Factor of the matrix scaled to a unit diagonal; empty if it is not safely positive definite.
struct ScaledFactor {
  MatrixXd lower;
  VectorXd scale;  // lower lower' = scale k scale
};

std::optional<ScaledFactor> factor(const MatrixXd& k) {
  ScaledFactor out;
  if (!(k.diagonal().minCoeff() > 0.0)) return std::nullopt;
  out.scale = k.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<MatrixXd> llt(out.scale.asDiagonal() * k * out.scale.asDiagonal());
  if (llt.info() != Eigen::Success) return std::nullopt;
  out.lower = llt.matrixL();
  if (!(out.lower.diagonal().array().square().minCoeff() > kLeastPivot)) return std::nullopt;
  return out;
}

// A thousandth of the lowest Rayleigh quotient of a single degree of freedom: small against most modes, and large
// enough to keep their digits.
double shift_for(const MatrixXd& k, const MatrixXd& m) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < k.rows(); ++i) {
    if (m(i, i) > 0.0 && k(i, i) > 0.0) least = std::min(least, k(i, i) / m(i, i));
  }
  return 1e-3 * least;
}

}  // namespace

std::optional<DensePairs> dense_pairs(const MatrixXd& k, const MatrixXd& m, Index n_vectors) {
  if (k.rows() == 0 || !k.allFinite() || !m.allFinite()) return std::nullopt;
  DensePairs out;
  auto f = factor(k);
  if (!f) {
    out.shift = shift_for(k, m);
    if (!std::isfinite(out.shift)) return std::nullopt;
    f = factor(k + out.shift * m);
    if (!f) return std::nullopt;
  }
  const auto lower = f->lower.triangularView<Eigen::Lower>();
  MatrixXd a = f->scale.asDiagonal() * m * f->scale.asDiagonal();
  lower.solveInPlace(a);
  a.transposeInPlace();
  lower.solveInPlace(a);
  a = (0.5 * (a + a.transpose())).eval();
  const SymmetricEigen eigen(std::move(a));
  out.mu = eigen.values();
  out.x = eigen.leading_vectors(std::min(n_vectors, k.rows()));
  f->lower.transpose().triangularView<Eigen::Upper>().solveInPlace(out.x);
  out.x = (f->scale.asDiagonal() * out.x).eval();
  return out;
}

}  // namespace core::structure
