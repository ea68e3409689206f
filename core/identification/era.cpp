#include "core/identification/era.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/identification/block_hankel.h"

namespace core {

namespace {

// Of unit-variance channels. Larger values cost the weakest mode, smaller ones let Cholesky fail (ARCHITECTURE.md).
constexpr double kRidge = 1e-6;

Eigen::VectorXd channel_scale(const Correlations& correlations) {
  Eigen::VectorXd scale(correlations.n_channels());
  for (int i = 0; i < scale.size(); ++i) scale[i] = std::sqrt(correlations.undivided(i, i, 0));
  return scale;
}

// Lower Cholesky factor with the smallest ridge that makes the matrix positive definite; empty when none does.
Eigen::MatrixXd cholesky_with_ridge(const Eigen::MatrixXd& covariance) {
  for (double ridge = kRidge; ridge < 1.0; ridge *= 10.0) {
    Eigen::MatrixXd raised = covariance;
    raised.diagonal().array() += ridge;
    const Eigen::LLT<Eigen::MatrixXd> factor(raised);
    if (factor.info() == Eigen::Success) return factor.matrixL();
  }
  return {};
}

Eigen::MatrixXd whiten(const Eigen::MatrixXd& left, const Eigen::MatrixXd& hankel, const Eigen::MatrixXd& right) {
  const Eigen::MatrixXd half = left.triangularView<Eigen::Lower>().solve(hankel);
  return right.triangularView<Eigen::Lower>().solve(half.transpose()).transpose();
}

}  // namespace

EraStatus realise(const Correlations& correlations, const EraConfig& config, Realisation& out) {
  const int p = config.block_rows;
  if (correlations.max_lag() < config.first_lag + 2 * p) return EraStatus::kTooFewLags;
  const int ny = correlations.n_channels();
  const Eigen::VectorXd scale = channel_scale(correlations);
  Eigen::MatrixXd h0 = block_hankel(correlations, config.references, scale, p, p, config.first_lag);
  Eigen::MatrixXd h1 = block_hankel(correlations, config.references, scale, p, p, config.first_lag + 1);
  Eigen::MatrixXd left;
  Eigen::MatrixXd right;
  if (config.canonical_variates) {
    std::vector<int> outputs(static_cast<std::size_t>(ny));
    std::iota(outputs.begin(), outputs.end(), 0);
    left = cholesky_with_ridge(block_toeplitz(correlations, outputs, scale, p, false));
    right = cholesky_with_ridge(block_toeplitz(correlations, config.references, scale, p, true));
    if (left.size() == 0 || right.size() == 0) return EraStatus::kRankDeficient;
    h0 = whiten(left, h0, right);
    h1 = whiten(left, h1, right);
  }
  if (!h0.allFinite() || !h1.allFinite()) return EraStatus::kRankDeficient;

  const Eigen::BDCSVD<Eigen::MatrixXd> svd(h0, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  Eigen::Index order = std::min<Eigen::Index>(config.max_order, s.size());
  while (order > 0 && !(s[order - 1] > 1e-12 * s[0])) --order;
  if (order < 2) return EraStatus::kRankDeficient;

  const Eigen::MatrixXd u = svd.matrixU().leftCols(order);
  const Eigen::MatrixXd v = svd.matrixV().leftCols(order);
  const Eigen::ArrayXd root = s.head(order).array().sqrt();
  out.singular_values = s;
  out.a = u.transpose() * h1 * v;
  out.a.array().colwise() /= root;
  out.a.array().rowwise() /= root.transpose();
  out.c = u.topRows(ny);
  if (config.canonical_variates) out.c = left.topLeftCorner(ny, ny).triangularView<Eigen::Lower>() * out.c;
  out.c = scale.asDiagonal() * out.c;
  out.c.array().rowwise() *= root.transpose();
  out.scale = scale;
  out.left_map = u.transpose();
  out.right_map = v;
  if (config.canonical_variates) {
    left.triangularView<Eigen::Lower>().solveInPlace<Eigen::OnTheRight>(out.left_map);
    right.triangularView<Eigen::Lower>().adjoint().solveInPlace(out.right_map);
  }
  out.left_map.array().colwise() /= root;
  out.right_map.array().rowwise() /= root.transpose();
  return EraStatus::kOk;
}

std::vector<DiscretePole> poles_of_order(const Realisation& realisation, int order) {
  const Eigen::Index n = std::min<Eigen::Index>(order, realisation.a.rows());
  const Eigen::EigenSolver<Eigen::MatrixXd> eigen(realisation.a.topLeftCorner(n, n));
  std::vector<DiscretePole> poles;
  if (eigen.info() != Eigen::Success) return poles;
  const Eigen::MatrixXcd shapes = realisation.c.leftCols(n) * eigen.eigenvectors();
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::complex<double> lambda = eigen.eigenvalues()[k];
    if (!(lambda.imag() > 0.0) || !std::isfinite(std::abs(lambda))) continue;
    DiscretePole pole{lambda, {}};
    pole.shape.assign(shapes.col(k).begin(), shapes.col(k).end());
    poles.push_back(std::move(pole));
  }
  return poles;
}

int canonical_order(const Realisation& realisation, double threshold) {
  int count = 0;
  for (Eigen::Index k = 0; k < realisation.a.rows(); ++k) count += realisation.singular_values[k] > threshold ? 1 : 0;
  return count + count % 2;
}

}  // namespace core
