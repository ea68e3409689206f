#include "core/closure/effects/lens_correction.h"

#include <cmath>

namespace core::closure {

void undo_lens(double k1, double p1, double p2, const CorrectionView& view, Eigen::MatrixXd& positions) {
  constexpr int kMostSteps = 30;
  constexpr double kEnough = 1e-9;
  const ObservationRecord& record = view.record;
  for (Eigen::Index k = 0; k < positions.cols(); ++k) {
    for (Eigen::Index j = 0; j < positions.rows() / 2; ++j) {
      const double xd = (positions(2 * j, k) - record.cx_px) / record.alpha_px;
      const double yd = (positions(2 * j + 1, k) - record.cy_px) / record.alpha_px;
      double x = xd, y = yd;
      for (int step = 0; step < kMostSteps; ++step) {
        const double r2 = x * x + y * y, radial = 1.0 + k1 * r2;
        const double x_new = (xd - 2.0 * p1 * x * y - p2 * (r2 + 2.0 * x * x)) / radial;
        const double y_new = (yd - p1 * (r2 + 2.0 * y * y) - 2.0 * p2 * x * y) / radial;
        const double change = std::abs(x_new - x) + std::abs(y_new - y);
        x = x_new, y = y_new;
        if (!(change > kEnough)) break;
      }
      if (!std::isfinite(x) || !std::isfinite(y)) x = xd, y = yd;
      positions(2 * j, k) = record.cx_px + record.alpha_px * x;
      positions(2 * j + 1, k) = record.cy_px + record.alpha_px * y;
    }
  }
}

}  // namespace core::closure
