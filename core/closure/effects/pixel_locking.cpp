#include "core/closure/effects/pixel_locking.h"

#include <cmath>
#include <numbers>

namespace core::closure {
namespace {

// Error periodic in the sub-pixel phase, two harmonics, the same along both axes. The phase is that of the predicted
// place: the measured one holds the error itself.
void correct(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) {
  for (Eigen::Index k = 0; k < positions.cols(); ++k) {
    for (Eigen::Index i = 0; i < positions.rows(); ++i) {
      const double phase = 2.0 * std::numbers::pi * view.predicted_px(i, k);
      positions(i, k) -= values(0) * std::sin(phase) + values(1) * std::cos(phase) + values(2) * std::sin(2.0 * phase) +
                         values(3) * std::cos(2.0 * phase);
    }
  }
}

}  // namespace

ObservationEffect pixel_locking_effect() {
  ObservationEffect effect;
  effect.name = "pixel locking";
  effect.form = ObservationEffect::Form::kGlobal;
  effect.parameters = {"sin", "cos", "sin 2", "cos 2"};
  effect.unit = "px";
  effect.waves_per_px = {1.0, 1.0, 2.0, 2.0};
  effect.plausible = 1.0;
  effect.of_tracker = true;
  effect.step = 1e-2;
  effect.correct = correct;
  return effect;
}

}  // namespace core::closure
