#include "core/closure/observation/effects/rotation_patterns.h"

#include <algorithm>

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

Eigen::MatrixXd rotation_patterns(const PointGeometry& g, bool complete) {
  Eigen::MatrixXd out(2 * g.x.size(), 3);
  out << roll_pattern(g), pitch_pattern(g), yaw_pattern(g);
  if (!complete) return out;
  for (Eigen::Index j = 0; j < g.x.size(); ++j) out(2 * j + 1, 1) += g.alpha_px, out(2 * j, 2) -= g.alpha_px;
  return out;
}

bool has_background(const ObservationRecord& record) {
  return std::any_of(record.region_of_point.begin(), record.region_of_point.end(),
                     [&](std::size_t r) { return !makes_channel(record.regions[r].role); });
}

}  // namespace core::closure
