#include "core/closure/effects/roll.h"

#include <numbers>

namespace core::closure {
namespace {

// Turn about the optical axis.
Eigen::VectorXd field(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j) out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(g.y(j), -g.x(j));
  return out;
}

}  // namespace

ObservationEffect roll_effect() {
  ObservationEffect effect;
  effect.name = "camera roll";
  effect.form = ObservationEffect::Form::kField;
  effect.parameters = {"rms"};
  effect.unit = "deg";
  effect.per_unit = 180.0 / std::numbers::pi;
  effect.plausible = 0.5;
  effect.turn = {0.0, 0.0, -1.0};
  effect.field = field;
  return effect;
}

}  // namespace core::closure
