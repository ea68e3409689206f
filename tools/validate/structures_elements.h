#pragma once

#include <Eigen/Core>

namespace tools {

// Textbook elements of length l that bend in a plane: deflection and rotation of both ends, E I = 1 (Clough & Penzien,
// Dynamics of Structures, 10.3 to 10.5).
[[nodiscard]] Eigen::Matrix4d bending_element(double l);
[[nodiscard]] Eigen::Matrix4d tension_element(double l);  // of a tension of 1

// A bar that shears (Timoshenko), kShearNodes evenly spaced nodes: deflection and rotation of each are polynomials
// between all of them, the energy of shear by one point of the rule less (Hughes, The Finite Element Method, 1987,
// 5.4). A section's radius of gyration
// counts as 0.1 mm, so that the mass matrix is definite.
inline constexpr Eigen::Index kShearNodes = 6;
struct ElementMatrices {
  Eigen::MatrixXd stiffness, mass;
};
[[nodiscard]] ElementMatrices shear_element(double l, double ei, double shear_stiffness, double mass_per_m);

// An element in a plane, motion of a node: x, z, turn.
struct PlaneElement {
  double along_x, along_z;  // from its first node to its last
  double ei, ea, mass_per_m;
};
// Between the node `from` and the next.
void add_plane_element(Eigen::MatrixXd& stiffness, Eigen::MatrixXd& mass, Eigen::Index from,
                       const PlaneElement& element);
// The same of a bar that shears, from the node `from` on.
void add_plane_shear_element(Eigen::MatrixXd& stiffness, Eigen::MatrixXd& mass, Eigen::Index from,
                             const PlaneElement& element, double shear_stiffness);

}  // namespace tools
