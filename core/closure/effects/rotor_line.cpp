#include "core/closure/effects/rotor_line.h"

#include <cmath>

#include "core/closure/effects/pitch.h"
#include "core/closure/effects/roll.h"
#include "core/closure/effects/yaw.h"

namespace core::closure {
namespace {

constexpr double kLeastReadout_frames = 0.2;

}  // namespace

// The search is that of core/closure/observation/line_search.h.
ObservationEffect rotor_line_effect() {
  ObservationEffect effect;
  effect.name = "rotor line";
  effect.form = ObservationEffect::Form::kLine;
  effect.parameters = {"frequency"};
  effect.unit = "Hz";
  return effect;
}

Eigen::MatrixXd rotor_fields(const PointGeometry& geometry, double readout_frames) {
  Eigen::MatrixXd fields(2 * geometry.x.size(), 3);
  fields.col(0) = roll_effect().field(geometry);
  fields.col(1) = pitch_effect().field(geometry);
  fields.col(2) = yaw_effect().field(geometry);
  if (std::abs(readout_frames) < kLeastReadout_frames) return fields;
  for (Eigen::Index j = 0; j < geometry.x.size(); ++j) {
    fields(2 * j + 1, 1) += geometry.alpha_px;
    fields(2 * j, 2) -= geometry.alpha_px;
  }
  return fields;
}

}  // namespace core::closure
