#include "core/closure/observation/effects/lens_effect.h"

#include <cmath>

namespace core::closure {

void undo_lens(const LensCoefficients& lens, const CorrectionView& view, Eigen::MatrixXd& positions) {
  constexpr int kMostSteps = 30;
  constexpr double kEnough = 1e-9;
  const auto& [k1, p1, p2] = lens;
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

void LensEffect::add_to(RunCorrection& correction, const std::vector<ParameterValue>& parameters,
                        const CameraModel& camera) const {
  Eigen::VectorXd values(static_cast<Eigen::Index>(n_parameters()));
  if (parameters.size() != n_parameters()) return;
  for (std::size_t i = 0; i < parameters.size(); ++i) values(static_cast<Eigen::Index>(i)) = parameters[i].value;
  if (values.isZero(0.0)) return;
  const LensCoefficients own = coefficients(values);
  CameraModel& lens = correction.places.lens;
  if (!lens.calibrated()) lens = {camera.fx, camera.fx, camera.cx, camera.cy, {}, LensModel::kRadialTangential};
  lens.distortion[0] += own.k1, lens.distortion[2] += own.p1, lens.distortion[3] += own.p2;
}

}  // namespace core::closure
