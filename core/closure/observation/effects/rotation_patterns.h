#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string>

#include "core/closure/observation/kinds/pattern_effect.h"

namespace core::closure {

// First order of a rotation of the camera: px per rad, 2 points long. Of pitch and yaw the constant part, a
// translation, is left out: it is free in every frame.
[[nodiscard]] Eigen::VectorXd roll_pattern(const PointGeometry& g);
[[nodiscard]] Eigen::VectorXd pitch_pattern(const PointGeometry& g);
[[nodiscard]] Eigen::VectorXd yaw_pattern(const PointGeometry& g);

// Roll, pitch and yaw side by side, 2 points x 3; complete: with the constant parts.
[[nodiscard]] Eigen::MatrixXd rotation_patterns(const PointGeometry& g, bool complete);

// Is anything seen that does not belong to the structure?
[[nodiscard]] bool has_background(const ObservationRecord& record);

// Rotation about one axis of the camera, in degrees.
class RotationEffect : public PatternEffect {
 public:
  [[nodiscard]] std::string unit() const final { return "deg"; }
  [[nodiscard]] double per_unit() const final { return 180.0 / std::numbers::pi; }
};

}  // namespace core::closure
