#include "core/closure/observation/effects/rotation_patterns.h"

namespace core::closure {

Eigen::VectorXd roll_pattern(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j) out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(g.y(j), -g.x(j));
  return out;
}

Eigen::VectorXd pitch_pattern(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j)
    out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(g.x(j) * g.y(j), g.y(j) * g.y(j));
  return out;
}

Eigen::VectorXd yaw_pattern(const PointGeometry& g) {
  Eigen::VectorXd out(2 * g.x.size());
  for (Eigen::Index j = 0; j < g.x.size(); ++j)
    out.segment<2>(2 * j) = g.alpha_px * Eigen::Vector2d(-g.x(j) * g.x(j), -g.x(j) * g.y(j));
  return out;
}

}  // namespace core::closure
