#include "core/closure/effects/radial_distortion.h"

#include "core/closure/effects/lens_correction.h"

namespace core::closure {
namespace {

void correct(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) {
  undo_lens(values(0), 0.0, 0.0, view, positions);
}

}  // namespace

ObservationEffect radial_distortion_effect() {
  ObservationEffect effect;
  effect.name = "radial distortion";
  effect.form = ObservationEffect::Form::kGlobal;
  effect.parameters = {"k1"};
  effect.plausible = 1.0;
  effect.step = 1e-3;
  effect.correct = correct;
  return effect;
}

}  // namespace core::closure
