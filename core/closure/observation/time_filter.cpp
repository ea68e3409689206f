#include "core/closure/observation/time_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/linear/dense.h"

namespace core::closure {
Eigen::MatrixXd low_cosines(Eigen::Index n_frames, double rate_hz, double limit_hz) {
  const auto n = static_cast<double>(n_frames);
  const auto count = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(2.0 * limit_hz * n / rate_hz) + 1, 1, n_frames);
  Eigen::MatrixXd cosines(n_frames, count);
  for (Eigen::Index m = 0; m < count; ++m) {
    const double scale = std::sqrt((m == 0 ? 1.0 : 2.0) / n);
    for (Eigen::Index k = 0; k < n_frames; ++k)
      cosines(k, m) = scale * std::cos(std::numbers::pi * static_cast<double>(m) * (static_cast<double>(k) + 0.5) / n);
  }
  return cosines;
}

Eigen::MatrixXd low_amplitudes(const Eigen::MatrixXd& values, const Eigen::MatrixXd& cosines) {
  const Eigen::Index n = values.cols(), half = n / 2, count = cosines.cols();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(values.rows(), count);
  const Eigen::MatrixXd first = values.leftCols(half), last = values.rightCols(half).rowwise().reverse();
  for (const Eigen::Index odd : {0, 1}) {
    const Eigen::Index n_part = (count + 1 - odd) / 2;
    if (n_part == 0) continue;
    Eigen::MatrixXd part(half, n_part), sum = Eigen::MatrixXd::Zero(values.rows(), n_part);
    for (Eigen::Index c = 0; c < n_part; ++c) part.col(c) = cosines.col(2 * c + odd).head(half);
    add_product(sum, 1.0, odd == 0 ? (first + last).eval() : (first - last).eval(), part);
    for (Eigen::Index c = 0; c < n_part; ++c) out.col(2 * c + odd) = sum.col(c);
  }
  if (n % 2 == 1) out += values.col(half) * cosines.row(half);
  return out;
}

}  // namespace core::closure
