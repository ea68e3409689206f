#include "core/identification/block_covariance.h"

namespace core {

Eigen::MatrixXd block_covariance(const Correlations& correlations, const Eigen::VectorXd& scale,
                                 const SampleWindow& rows, const SampleWindow& columns, Estimate estimate) {
  const auto n_i = static_cast<int>(rows.channels.size()), n_j = static_cast<int>(columns.channels.size());
  Eigen::MatrixXd out(rows.size(), columns.size());
  for (int b = 0; b < columns.n; ++b) {
    for (int j = 0; j < n_j; ++j) {
      const int cj = columns.channels[static_cast<std::size_t>(j)];
      for (int a = 0; a < rows.n; ++a) {
        const int lag = rows.time(a) - columns.time(b);
        for (int i = 0; i < n_i; ++i) {
          const int ci = rows.channels[static_cast<std::size_t>(i)];
          const double r =
              estimate == Estimate::kDivided ? correlations.divided(ci, cj, lag) : correlations.undivided(ci, cj, lag);
          out(a * n_i + i, b * n_j + j) = r / (scale[ci] * scale[cj]);
        }
      }
    }
  }
  return out;
}

}  // namespace core
