#pragma once

#include <Eigen/Core>
#include <numbers>
#include <string>

#include "core/closure/observation/kinds/pattern_effect.h"

namespace core::closure {

// First order of a camera rotation: px per rad, 2 points long. The constant parts of pitch and yaw are translations,
// which are free in every frame, and are left out.
[[nodiscard]] Eigen::VectorXd roll_pattern(const PointGeometry& g);
[[nodiscard]] Eigen::VectorXd pitch_pattern(const PointGeometry& g);
[[nodiscard]] Eigen::VectorXd yaw_pattern(const PointGeometry& g);

// Roll, pitch and yaw as columns, 2 points x 3; complete: with the constant parts.
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
