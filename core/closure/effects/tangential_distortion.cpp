#include "core/closure/effects/tangential_distortion.h"

#include "core/closure/effects/lens_correction.h"

namespace core::closure {
namespace {

void correct(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) {
  undo_lens(0.0, values(0), values(1), view, positions);
}

}  // namespace

ObservationEffect tangential_distortion_effect() {
  ObservationEffect effect;
  effect.name = "tangential distortion";
  effect.form = ObservationEffect::Form::kGlobal;
  effect.parameters = {"p1", "p2"};
  effect.plausible = 0.1;
  effect.step = 1e-4;
  effect.correct = correct;
  return effect;
}

}  // namespace core::closure
