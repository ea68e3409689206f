#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace core::structure {

// Rigid floors of equal height on columns in shear, fixed at the ground (Chopra, Dynamics of Structures, 9.1), and
// departures from it. Frequencies determine only ratios of stiffness and mass: masses are relative; stiffness is in
// units of 1/s^2 times a relative mass. Lowest storey first. Flexibilities are relative to the mean storey stiffness k,
// heights h are storey heights: 0 is the ideal shear frame.
struct ShearFrame {
  std::vector<double> mass;
  std::vector<double> stiffness_per_s2;  // of the columns below that floor
  // Storey columns clamped into floors that rotate: (E I / h) of a storey's columns over the rotational stiffness of a
  // floor. Rotations have no mass (static condensation).
  double joint_flexibility = 0.0;
  // Rotation of the foundation: k h^2 over its rotational stiffness.
  double rocking_flexibility = 0.0;
  // Bending of the whole frame as a cantilever, in series with its shear (Timoshenko): k h^3 / (E I of the whole).
  double bending_flexibility = 0.0;
  // P-delta of leaning storeys (linear): reduces each storey's stiffness by the weight above over its height.
  double gravity_over_height_per_s2 = 0.0;
};

struct FrameModes {
  Eigen::VectorXd frequency_hz;  // ascending
  Eigen::MatrixXd shapes;        // floors x modes, largest component 1; 0 x 0 if not requested
};

// Stiffness of the floors' displacements, floors x floors. `frame` holds n >= 1 storeys, masses and stiffnesses
// positive, flexibilities >= 0.
[[nodiscard]] Eigen::MatrixXd stiffness_per_s2(const ShearFrame& frame);

// Empty if the frame has no stiffness left (gravity buckles it), or if values are not finite.
[[nodiscard]] std::optional<FrameModes> frame_modes(const ShearFrame& frame, bool with_shapes);

// P-delta coefficient of the ground storey: the weight above over its height, relative to the stiffness of its columns.
// Eurocode 8 (4.4.2.2) limits it to 0.3; at 1 the structure buckles.
[[nodiscard]] double stability_coefficient(const ShearFrame& frame);

}  // namespace core::structure
