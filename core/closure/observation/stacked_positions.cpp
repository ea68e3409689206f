#include "core/closure/observation/stacked_positions.h"

#include <cmath>

namespace core::closure {

Eigen::MatrixXd stacked_positions(const ObservationRecord& record,
                                  std::vector<std::pair<Eigen::Index, Eigen::Index>>& missing) {
  Eigen::MatrixXd out(2 * record.n_points(), record.n_frames());
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    out.row(2 * j) = record.u_px.col(j).transpose();
    out.row(2 * j + 1) = record.v_px.col(j).transpose();
    for (Eigen::Index k = 0; k < out.cols(); ++k) {
      if (std::isnan(out(2 * j, k)) || std::isnan(out(2 * j + 1, k))) out(2 * j, k) = out(2 * j + 1, k) = std::nan("");
    }
  }
  for (Eigen::Index i = 0; i < out.rows(); ++i) {
    Eigen::Index last = -1;
    for (Eigen::Index k = 0; k <= out.cols(); ++k) {
      if (k < out.cols() && std::isnan(out(i, k))) {
        missing.emplace_back(i, k);
        continue;
      }
      for (Eigen::Index gap = last + 1; gap < k; ++gap) {
        const double before = last >= 0 ? out(i, last) : out(i, k), after = k < out.cols() ? out(i, k) : before;
        const double part = last >= 0 ? static_cast<double>(gap - last) / static_cast<double>(k - last) : 0.0;
        out(i, gap) = before + part * (after - before);
      }
      last = k;
    }
  }
  return out;
}

}  // namespace core::closure
