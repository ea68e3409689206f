#include "core/identification/block_hankel.h"

namespace core {

Eigen::MatrixXd block_hankel(const Correlations& correlations, const std::vector<int>& references,
                             const Eigen::VectorXd& scale, int block_rows, int block_columns, int first_lag) {
  const int ny = correlations.n_channels();
  const auto nr = static_cast<int>(references.size());
  Eigen::MatrixXd hankel(block_rows * ny, block_columns * nr);
  for (int b = 0; b < block_columns; ++b) {
    for (int r = 0; r < nr; ++r) {
      const int reference = references[static_cast<std::size_t>(r)];
      for (int a = 0; a < block_rows; ++a) {
        for (int y = 0; y < ny; ++y) {
          hankel(a * ny + y, b * nr + r) =
              correlations.divided(y, reference, first_lag + a + b) / (scale[y] * scale[reference]);
        }
      }
    }
  }
  return hankel;
}

Eigen::MatrixXd block_toeplitz(const Correlations& correlations, const std::vector<int>& channels,
                               const Eigen::VectorXd& scale, int n_blocks, bool past_order) {
  const auto n = static_cast<int>(channels.size());
  Eigen::MatrixXd toeplitz(n_blocks * n, n_blocks * n);
  for (int a = 0; a < n_blocks; ++a) {
    for (int b = 0; b < n_blocks; ++b) {
      const int lag = past_order ? b - a : a - b;
      for (int i = 0; i < n; ++i) {
        const int ci = channels[static_cast<std::size_t>(i)];
        for (int j = 0; j < n; ++j) {
          const int cj = channels[static_cast<std::size_t>(j)];
          toeplitz(a * n + i, b * n + j) = correlations.undivided(ci, cj, lag) / (scale[ci] * scale[cj]);
        }
      }
    }
  }
  return toeplitz;
}

}  // namespace core
