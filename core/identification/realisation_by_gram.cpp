#include "core/identification/realisation_by_gram.h"

#include <cmath>
#include <utility>

#include "core/identification/block_hankel.h"
#include "core/identification/given_inputs.h"
#include "core/identification/hankel_gram.h"
#include "core/identification/hankel_weights.h"
#include "core/linear/dense.h"
#include "core/linear/symmetric_eigen.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Relative to the largest singular value; its square is 1e-8, far above the rounding error.
constexpr double kLeastSingularValue = 1e-4;

// G^T G = V S^2 V^T: the leading part.
struct RightVectors {
  VectorXd s;    // all, descending
  MatrixXd v_t;  // order x n
};

GramStatus right_vectors(MatrixXd gram, const EraConfig& config, RightVectors& out) {
  if (!gram.allFinite()) return GramStatus::kRankDeficient;
  const SymmetricEigen eigen(std::move(gram));
  out.s = eigen.values().cwiseMax(0.0).cwiseSqrt();
  if (!(out.s[0] > 0.0)) return GramStatus::kRankDeficient;
  Index order = wanted_order(config, out.s);
  // Given inputs there is no other decomposition: canonical correlations this small belong to no mode.
  while (!config.inputs.empty() && order > 0 && out.s[order - 1] < kLeastSingularValue * out.s[0]) --order;
  if (order < 2) return GramStatus::kRankDeficient;
  if (out.s[order - 1] < kLeastSingularValue * out.s[0]) return GramStatus::kIllConditioned;
  out.v_t = eigen.leading_vectors(order).transpose();
  return GramStatus::kOk;
}

MatrixXd product(const MatrixXd& a, const Eigen::Ref<const MatrixXd>& b) {
  MatrixXd c = MatrixXd::Zero(a.rows(), b.cols());
  add_product(c, 1.0, a, b);
  return c;
}

MatrixXd product_transposed(const MatrixXd& a, const Eigen::Ref<const MatrixXd>& b) {
  MatrixXd c = MatrixXd::Zero(a.rows(), b.rows());
  add_product_transposed(c, 1.0, a, b);
  return c;
}

// One block row of the observability matrix, from the transposed block row of U.
MatrixXd seen(const MatrixXd& u_t, const VectorXd& scale, const VectorXd& root) {
  return scale.asDiagonal() * u_t.transpose() * root.asDiagonal();
}

// U = G V S^-1 is never formed: A = S^-3/2 V^T (H0^T H1) V S^-1/2.
GramStatus realise_plain(const Correlations& correlations, const EraConfig& config, Realisation& out) {
  const VectorXd scale = channel_scale(correlations);
  const MatrixXd gram = hankel_gram(correlations, config.references, scale, config.block_rows, config.first_lag);
  const auto nr = static_cast<Index>(config.references.size());
  const Index n = config.block_rows * nr;
  RightVectors right;
  const GramStatus status = right_vectors(gram.topLeftCorner(n, n), config, right);
  if (status != GramStatus::kOk) return status;
  const VectorXd s = right.s.head(right.v_t.rows());
  const VectorXd root = s.cwiseSqrt();
  const MatrixXd by_s = s.cwiseInverse().asDiagonal() * right.v_t;        // U = H0 by_s^T
  const MatrixXd by_root = root.cwiseInverse().asDiagonal() * right.v_t;  // right_map^T
  const MatrixXd left = root.cwiseInverse().asDiagonal() * by_s;          // left_map = left H0^T
  out.scale = scale;
  out.singular_values = right.s;
  out.a = product_transposed(product(left, gram.block(0, nr, n, n)), by_root);
  const MatrixXd top = block_hankel(correlations, config.references, scale, 1, config.block_rows, config.first_lag);
  const int last_lag = config.first_lag + config.block_rows - 1;
  const MatrixXd end = block_hankel(correlations, config.references, scale, 1, config.block_rows, last_lag);
  out.c = seen(product_transposed(by_s, top), scale, root);
  out.c_last = seen(product_transposed(by_s, end), scale, root);
  out.n_steps = config.block_rows - 1;
  if (config.with_maps) {
    const MatrixXd h0 =
        block_hankel(correlations, config.references, scale, config.block_rows, config.block_rows, config.first_lag);
    out.left_map = product_transposed(left, h0);
    out.right_map = by_root.transpose();
  }
  return GramStatus::kOk;
}

// Factored parts of a weighted Hankel matrix G = Lf^-1 H0 Lp^-T; Lp and G stacked.
struct Weighted {
  MatrixXd future;  // Lf
  MatrixXd right;   // [Lp; G]
  MatrixXd next_t;  // (Lf^-1 H1)^T
};

// ny: outputs, whose standard deviations are `scale`.
GramStatus balance(const Weighted& by, const VectorXd& scale, const EraConfig& config, Realisation& out) {
  const Index ny = scale.size(), n_rows = by.future.rows(), n_columns = by.right.cols();
  const MatrixXd g_t = by.right.bottomRows(n_rows).transpose();
  RightVectors vectors;
  const GramStatus status = right_vectors(core::gram(g_t), config, vectors);
  if (status != GramStatus::kOk) return status;

  const VectorXd s = vectors.s.head(vectors.v_t.rows());
  const VectorXd root = s.cwiseSqrt();
  const MatrixXd by_root = root.cwiseInverse().asDiagonal() * vectors.v_t;
  const MatrixXd u_t = s.cwiseInverse().asDiagonal() * product(vectors.v_t, g_t);
  const MatrixXd by_root_u = root.cwiseInverse().asDiagonal() * u_t;
  MatrixXd right_map_t = by_root;
  divide_by_lower(right_map_t, by.right.topRows(n_columns));
  out.singular_values = vectors.s;
  out.a = product_transposed(product_transposed(by_root_u, by.next_t), right_map_t);
  out.c = seen(product_transposed(u_t.leftCols(ny), by.future.topLeftCorner(ny, ny)), scale, root);
  out.c_last = seen(product_transposed(u_t, by.future.bottomRows(ny)), scale, root);
  out.n_steps = config.block_rows - 1;
  if (config.with_maps) {
    out.left_map = by_root_u;
    divide_by_lower(out.left_map, by.future);
    out.right_map = right_map_t.transpose();
  }
  return GramStatus::kOk;
}

GramStatus realise_weighted(const Correlations& correlations, const EraConfig& config, Realisation& out) {
  const int p = config.block_rows;
  const auto nr = static_cast<Index>(config.references.size());
  out.scale = channel_scale(correlations);
  // [H0, last block column of H1]: H1 is the same matrix one block column further.
  const MatrixXd wide = block_hankel(correlations, config.references, out.scale, p, p + 1, config.first_lag);
  if (!wide.allFinite()) return GramStatus::kRankDeficient;
  MatrixXd left;  // [Lf; (Lf^-1 wide)^T]
  if (!factor_with_ridge(future_covariance(correlations, config, out.scale), wide.transpose(), left)) {
    return GramStatus::kRankDeficient;
  }
  const Index n_rows = p * out.scale.size(), n_columns = p * nr;
  const MatrixXd half = left.bottomRows(n_columns + nr);
  Weighted by{left.topRows(n_rows), {}, half.bottomRows(n_columns)};
  if (!factor_with_ridge(past_covariance(correlations, config, out.scale), half.topRows(n_columns).transpose(),
                         by.right)) {
    return GramStatus::kRankDeficient;
  }
  return balance(by, out.scale, config, out);
}

// Rows of all channels; those of inputs are zero.
MatrixXd with_input_rows(const MatrixXd& outputs, const std::vector<int>& channels, Index n_channels) {
  MatrixXd out = MatrixXd::Zero(n_channels, outputs.cols());
  for (std::size_t i = 0; i < channels.size(); ++i) out.row(channels[i]) = outputs.row(static_cast<Index>(i));
  return out;
}

GramStatus realise_given_inputs(const Correlations& correlations, const EraConfig& config, Realisation& out) {
  out.scale = channel_scale(correlations);
  const std::vector<int> outputs = given_inputs(config, correlations.n_channels()).future.channels;
  VectorXd output_scale(static_cast<Index>(outputs.size()));
  for (std::size_t i = 0; i < outputs.size(); ++i) output_scale[static_cast<Index>(i)] = out.scale[outputs[i]];
  ConditionedHankel given;
  if (!condition_on_inputs(correlations, config, out.scale, given)) return GramStatus::kRankDeficient;
  const Index n_rows = given.future.rows(), n_columns = given.past.rows();
  MatrixXd both(2 * n_columns, n_rows), left;  // [H0, H1]^T; [Lf; (Lf^-1 [H0, H1])^T]
  both << given.hankel.topRows(n_rows).transpose(), given.hankel.bottomRows(n_rows).transpose();
  if (!factor_with_ridge(given.future, both, left)) return GramStatus::kRankDeficient;
  Weighted by{left.topRows(n_rows), {}, left.bottomRows(n_columns)};
  if (!factor_with_ridge(given.past, left.middleRows(n_rows, n_columns).transpose(), by.right)) {
    return GramStatus::kRankDeficient;
  }
  const GramStatus status = balance(by, output_scale, config, out);
  if (status != GramStatus::kOk) return status;
  for (MatrixXd* c : {&out.c, &out.c_last}) *c = with_input_rows(*c, outputs, out.scale.size());
  out.by_input = std::move(given.by_input);
  out.of_past = std::move(given.of_past);
  return GramStatus::kOk;
}

}  // namespace

GramStatus realise_by_gram(const Correlations& correlations, const EraConfig& config, Realisation& out) {
  if (!config.canonical_variates) return realise_plain(correlations, config, out);
  return config.inputs.empty() ? realise_weighted(correlations, config, out)
                               : realise_given_inputs(correlations, config, out);
}

}  // namespace core
