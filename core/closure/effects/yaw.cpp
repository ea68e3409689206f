#include "core/closure/effects/yaw.h"

#include <numbers>

namespace core::closure {
namespace {

// The constant part of -(1 + x^2, x y) is a translation, which is free anyway.
Eigen::VectorXd field(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j)
    out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(-g.x(j) * g.x(j), -g.x(j) * g.y(j));
  return out;
}

}  // namespace

ObservationEffect yaw_effect() {
  ObservationEffect effect;
  effect.name = "camera yaw";
  effect.form = ObservationEffect::Form::kField;
  effect.parameters = {"rms"};
  effect.unit = "deg";
  effect.per_unit = 180.0 / std::numbers::pi;
  effect.plausible = 0.5;
  effect.turn = {0.0, -1.0, 0.0};
  effect.field = field;
  return effect;
}

}  // namespace core::closure
