#include "core/identification/hankel_gram.h"

#include "core/identification/block_hankel.h"
#include "core/linear/dense.h"

namespace core {

Eigen::MatrixXd hankel_gram(const Correlations& correlations, const std::vector<int>& references,
                            const Eigen::VectorXd& scale, int n_blocks, int first_lag) {
  using Eigen::Index;
  using Eigen::MatrixXd;
  const auto nr = static_cast<Index>(references.size());
  const Index n = n_blocks * nr;
  const Index n_wide = n + nr;
  // R(first_lag), R(first_lag + 1), ... as adjacent blocks of outputs x references.
  const MatrixXd lags = block_hankel(correlations, references, scale, 1, 2 * n_blocks, first_lag);
  const MatrixXd stacked = lags.transpose();

  MatrixXd first = MatrixXd::Zero(n_wide, nr);
  for (Index a = 0; a < n_blocks; ++a) {
    add_product(first, 1.0, stacked.middleRows(a * nr, n_wide), lags.middleCols(a * nr, nr));
  }
  MatrixXd gram = MatrixXd::Zero(n_wide, n_wide);
  add_product_transposed(gram.bottomRightCorner(n, n), -1.0, stacked.topRows(n), stacked.topRows(n));
  add_product_transposed(gram.bottomRightCorner(n, n), 1.0, stacked.bottomRows(n), stacked.bottomRows(n));
  gram.leftCols(nr) = first;
  gram.topRows(nr) = first.transpose();
  for (Index j = nr; j < n_wide; ++j) gram.col(j).tail(n) += gram.col(j - nr).head(n);
  return gram;
}

}  // namespace core
