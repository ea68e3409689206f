#include "core/closure/observation/lens_coefficients.h"

#include <cmath>

namespace core::closure {
namespace {

Eigen::Vector2d undone(const LensCoefficients& lens, const Eigen::Vector2d& distorted) {
  constexpr int kMostSteps = 30;
  constexpr double kEnough = 1e-9;
  const auto& [k1, k2, p1, p2, k3] = lens;
  double x = distorted.x(), y = distorted.y();
  for (int step = 0; step < kMostSteps; ++step) {
    const double r2 = x * x + y * y, radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double x_new = (distorted.x() - 2.0 * p1 * x * y - p2 * (r2 + 2.0 * x * x)) / radial;
    const double y_new = (distorted.y() - p1 * (r2 + 2.0 * y * y) - 2.0 * p2 * x * y) / radial;
    const double change = std::abs(x_new - x) + std::abs(y_new - y);
    x = x_new, y = y_new;
    if (!(change > kEnough)) break;
  }
  return std::isfinite(x) && std::isfinite(y) ? Eigen::Vector2d(x, y) : distorted;
}

}  // namespace

void undo_lens(const LensCoefficients& lens, const ObservationRecord& record, Eigen::MatrixXd& positions) {
  if (lens.none()) return;
  const Eigen::Vector2d centre(record.cx_px, record.cy_px);
  for (Eigen::Index k = 0; k < positions.cols(); ++k) {
    for (Eigen::Index j = 0; j < positions.rows() / 2; ++j) {
      auto at = positions.block<2, 1>(2 * j, k);
      at = centre + record.alpha_px * undone(lens, (at - centre) / record.alpha_px);
    }
  }
}

}  // namespace core::closure
