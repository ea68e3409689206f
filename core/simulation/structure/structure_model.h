#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace core::simulation {

// Linear structure on a moving ground: M q'' + C q' + K q = P^T f - L a, with q the coordinates relative to the ground,
// f the forces on the bodies and a the ground's acceleration (mm/s^2). Any consistent units, e.g. kg, N/m, N s/m with q
// in mm and f in mN. Bodies are the visible parts: body i (1 .. n_bodies) moves by P.row(i - 1) q along `axis` and
// rotates by T.row(i - 1) q. Body 0 is the ground.
struct StructureModel {
  enum class Axis : std::uint8_t { kX, kY };  // of the motion, in the world: to the right, or downwards

  Eigen::MatrixXd mass, damping, stiffness;  // coordinates x coordinates, symmetric
  Eigen::VectorXd influence;                 // L: M times the coordinates' rigid motion with 1 mm of the ground
  Eigen::MatrixXd displacement;              // P: bodies x coordinates, mm per unit
  Eigen::MatrixXd tilt;                      // T: bodies x coordinates, rad per unit; from X towards Y about Z
  Axis axis = Axis::kX;

  [[nodiscard]] int n_bodies() const noexcept { return static_cast<int>(displacement.rows()); }  // without the ground
  [[nodiscard]] int n_coordinates() const noexcept { return static_cast<int>(mass.rows()); }
};

// One mode of free vibration. Shapes over the bodies, the largest displacement 1.
struct TrueMode {
  double frequency_hz = 0.0;   // |s| / (2 pi)
  double damping_ratio = 0.0;  // -Re s / |s|
  Eigen::VectorXcd displacement;
  Eigen::VectorXcd tilt;  // rad per mm of the largest displacement
};

// Modes of the state matrix [0 I; -M^-1 K, -M^-1 C], by frequency. Poles that do not oscillate, and modes that do not
// move a body, are omitted.
[[nodiscard]] std::vector<TrueMode> modes_of(const StructureModel& model);

// q for unit forces on the coordinates at angular frequency w: (K - w^2 M + i w C)^-1 force.
[[nodiscard]] Eigen::VectorXcd response_at(const StructureModel& model, double w, const Eigen::VectorXcd& force);

// Throws std::invalid_argument: inconsistent sizes, NaN, a matrix that is not symmetric, a mass matrix that is not
// positive definite, a pole that does not decay (a damping ratio below 1e-10, a stiffness that is not positive
// definite).
void validate(const StructureModel& model);

// Shear building of uniform masses with the shapes of the uniform fixed-free chain, phi_r(i) = sin((2 r - 1) i pi /
// (2 n + 1)), one storey for each frequency; frequencies and damping ratios are given.
[[nodiscard]] StructureModel uniform_chain(const std::vector<double>& frequency_hz,
                                           const std::vector<double>& damping_ratio);

// Shapes of that chain, floors x modes, each scaled to a largest component of +1.
[[nodiscard]] Eigen::MatrixXd shear_chain_shapes(int n_floors);

}  // namespace core::simulation
