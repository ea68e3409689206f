#include "core/identification/realisation_by_svd.h"

#include <Eigen/SVD>
#include <algorithm>

#include "core/identification/block_hankel.h"
#include "core/identification/hankel_weights.h"

namespace core {

namespace {

using Eigen::MatrixXd;

MatrixXd whiten(const HankelWeights& weights, const MatrixXd& hankel) {
  const MatrixXd half = weights.left.triangularView<Eigen::Lower>().solve(hankel);
  return weights.right.triangularView<Eigen::Lower>().solve(half.transpose()).transpose();
}

}  // namespace

EraStatus realise_by_svd(const Correlations& correlations, const EraConfig& config, Realisation& out) {
  const int p = config.block_rows;
  const int ny = correlations.n_channels();
  const Eigen::VectorXd scale = channel_scale(correlations);
  MatrixXd h0 = block_hankel(correlations, config.references, scale, p, p, config.first_lag);
  MatrixXd h1 = block_hankel(correlations, config.references, scale, p, p, config.first_lag + 1);
  HankelWeights weights;
  if (config.canonical_variates) {
    if (!hankel_weights(correlations, config, scale, weights)) return EraStatus::kRankDeficient;
    h0 = whiten(weights, h0);
    h1 = whiten(weights, h1);
  }
  if (!h0.allFinite() || !h1.allFinite()) return EraStatus::kRankDeficient;

  const Eigen::BDCSVD<MatrixXd> svd(h0, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  const Eigen::Index order = wanted_order(config, s);
  if (order < 2) return EraStatus::kRankDeficient;

  const MatrixXd u = svd.matrixU().leftCols(order);
  const MatrixXd v = svd.matrixV().leftCols(order);
  const Eigen::ArrayXd root = s.head(order).array().sqrt();
  out.scale = scale;
  out.singular_values = s;
  out.a = u.transpose() * h1 * v;
  out.a.array().colwise() /= root;
  out.a.array().rowwise() /= root.transpose();
  out.c = u.topRows(ny);
  out.c_last = u.bottomRows(ny);
  out.n_steps = p - 1;
  out.left_map = u.transpose();
  out.right_map = v;
  if (config.canonical_variates) {
    out.c = weights.left.topLeftCorner(ny, ny).triangularView<Eigen::Lower>() * out.c;
    out.c_last = (weights.left.triangularView<Eigen::Lower>() * u).bottomRows(ny);
    weights.left.triangularView<Eigen::Lower>().solveInPlace<Eigen::OnTheRight>(out.left_map);
    weights.right.triangularView<Eigen::Lower>().adjoint().solveInPlace(out.right_map);
  }
  for (MatrixXd* c : {&out.c, &out.c_last}) {
    *c = scale.asDiagonal() * *c;
    c->array().rowwise() *= root.transpose();
  }
  out.left_map.array().colwise() /= root;
  out.right_map.array().rowwise() /= root.transpose();
  return EraStatus::kOk;
}

}  // namespace core
