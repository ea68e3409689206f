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

// A turn of the image in its own plane, as far as the residual of a fit shows it in these rungs: the frequencies of its
// power and the point about which it turns. The camera turns everything about the optical axis, a rocking structure
// about its base; both leave the same residual, but the base's own displacement in the model follows the turn in the
// first case only.
struct RollCourse {
  double low_hz = 0.0, middle_hz = 0.0, high_hz = 0.0;  // 16, 50 and 84 % quantiles of its power above the noise
  double about_axis = 0.0;                              // 1: about the optical axis, 0: about the base
  double sigma = 0.0;                                   // of about_axis; infinite where no base is seen

  [[nodiscard]] bool is_resonance() const noexcept;   // narrow, above the drift of a hover
  [[nodiscard]] bool is_vibration() const noexcept;   // narrow, in the band of camera_vibration
  [[nodiscard]] bool is_about_axis() const noexcept;  // and not about the base, by four sigma
  [[nodiscard]] bool is_about_base() const noexcept;  // and not about the axis
};
[[nodiscard]] RollCourse roll_course(const FitView& fit, RungSet band);

// Why a resonance without a background is not the camera's; empty: it is, or a background decides.
[[nodiscard]] std::string not_of_camera(const RollCourse& course, const FitView& fit);

// Rotation about one axis of the camera, in degrees.
class RotationEffect : public PatternEffect {
 public:
  [[nodiscard]] std::string unit() const final { return "deg"; }
  [[nodiscard]] double per_unit() const final { return 180.0 / std::numbers::pi; }
};

}  // namespace core::closure
