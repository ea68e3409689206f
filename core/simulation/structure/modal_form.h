#pragma once

#include <Eigen/Core>

namespace core::simulation {

// Equations of motion in the coordinates z of the undamped modes, q = shapes z: z'' + damping z' + diag(w^2) z =
// shapes^T force. `diagonal`: the damping is proportional (Caughey & O'Kelly 1965), each mode is an oscillator of its
// own.
struct ModalForm {
  Eigen::VectorXd w;        // rad/s, ascending
  Eigen::MatrixXd shapes;   // coordinates x modes, shapes^T M shapes = 1
  Eigen::MatrixXd damping;  // shapes^T C shapes, 1/s
  bool diagonal = true;
};

// Mass and stiffness must be symmetric and positive definite.
[[nodiscard]] ModalForm modal_form(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& damping,
                                   const Eigen::MatrixXd& stiffness);

// Poles s and their shapes in q: both of each pair, and those that do not oscillate. Unordered.
struct Poles {
  Eigen::VectorXcd s;
  Eigen::MatrixXcd shapes;  // coordinates x poles
};
[[nodiscard]] Poles poles_of(const ModalForm& form);

// z at angular frequency w for forces on the modes (shapes^T force).
[[nodiscard]] Eigen::VectorXcd modal_response(const ModalForm& form, double w, const Eigen::VectorXcd& modal_force);

}  // namespace core::simulation
