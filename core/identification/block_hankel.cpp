#include "core/identification/block_hankel.h"

namespace core {

Eigen::MatrixXd block_hankel(const Correlations& correlations, const std::vector<int>& references,
                             const Eigen::VectorXd& scale, int block_rows, int block_columns, int first_lag) {
  const int ny = correlations.n_channels();
  const auto nr = static_cast<int>(references.size());
  // The first block column is filled lag by lag; each next one is the previous one moved up by a block, plus one new
  // lag.
  Eigen::MatrixXd hankel(block_rows * ny, block_columns * nr);
  for (int b = 0; b < block_columns; ++b) {
    const int first_row = b == 0 ? 0 : block_rows - 1;
    for (int r = 0; r < nr; ++r) {
      const int reference = references[static_cast<std::size_t>(r)];
      const int column = b * nr + r;
      if (b > 0) hankel.col(column).head(first_row * ny) = hankel.col(column - nr).tail(first_row * ny);
      for (int a = first_row; a < block_rows; ++a) {
        for (int y = 0; y < ny; ++y) {
          hankel(a * ny + y, column) =
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
  // The first block column is filled lag by lag; each next one is the previous one moved down a block, plus one new
  // lag.
  Eigen::MatrixXd toeplitz(n_blocks * n, n_blocks * n);
  for (int b = 0; b < n_blocks; ++b) {
    const int end_row = b == 0 ? n_blocks : 1;
    for (int j = 0; j < n; ++j) {
      const int cj = channels[static_cast<std::size_t>(j)];
      const int column = b * n + j;
      if (b > 0) toeplitz.col(column).tail((n_blocks - 1) * n) = toeplitz.col(column - n).head((n_blocks - 1) * n);
      for (int a = 0; a < end_row; ++a) {
        const int lag = past_order ? b - a : a - b;
        for (int i = 0; i < n; ++i) {
          const int ci = channels[static_cast<std::size_t>(i)];
          toeplitz(a * n + i, column) = correlations.undivided(ci, cj, lag) / (scale[ci] * scale[cj]);
        }
      }
    }
  }
  return toeplitz;
}

}  // namespace core
