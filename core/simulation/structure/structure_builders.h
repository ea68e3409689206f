#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/simulation/structure/structure_damping.h"
#include "core/simulation/structure/structure_model.h"

namespace core::simulation {

// Builders of validated models, motion along X. Matrices are in SI (kg, N/m, N s/m) while coordinates count mm: the
// equations are linear, so forces are then in mN, and no factor is needed. All throw std::invalid_argument.

// Rigid floors on columns that shear, one coordinate a floor (Chopra, Dynamics of Structures, 9.1): K is tridiagonal,
// K(i, i) = k(i) + k(i+1), K(i, i+1) = -k(i+1).
struct ShearBuilding {
  std::vector<double> mass_kg;            // by storey from the lowest
  std::vector<double> stiffness_n_per_m;  // of the columns below that floor
  // A spring without mass under the columns of the lowest storey, in series with them; 0 = rigid.
  double ground_spring_n_per_m = 0.0;
  // Given, gravity softens every storey (P-delta, linear: Chopra 9.1 / Wilson 11): k(i) - g * (mass from i up) / h(i).
  std::vector<double> storey_height_mm;
};
[[nodiscard]] StructureModel shear_frame(const ShearBuilding& frame, const Damping& damping);

// Given modes: bodies x modes of displacement and (rad per mm) tilt, at any scale. Modal mass r is the sum over bodies
// of mass * shape^2, participation the sum of mass * shape. No tilts: 0 x 0.
[[nodiscard]] StructureModel from_modes(const std::vector<double>& frequency_hz,
                                        const std::vector<double>& damping_ratio, const Eigen::MatrixXd& shapes,
                                        const std::vector<double>& mass_kg, const Eigen::MatrixXd& tilts = {});

// Each coordinate is the displacement of one body relative to the ground.
[[nodiscard]] StructureModel from_matrices(const Eigen::MatrixXd& mass_kg, const Eigen::MatrixXd& damping_n_s_per_m,
                                           const Eigen::MatrixXd& stiffness_n_per_m);

}  // namespace core::simulation
