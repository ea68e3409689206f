#include "core/closure/observation/effects/lens_effect.h"

namespace core::closure {

void LensEffect::remove(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) const {
  LensCoefficients all = view.lens;
  undo_lens(all += coefficients(values), view.record, positions);
}

CorrectionView LensEffect::beside(const Eigen::VectorXd& values, CorrectionView view) const {
  view.lens -= coefficients(values);
  return view;
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
  lens.distortion[0] += own.k1, lens.distortion[1] += own.k2;
  lens.distortion[2] += own.p1, lens.distortion[3] += own.p2, lens.distortion[4] += own.k3;
}

}  // namespace core::closure
