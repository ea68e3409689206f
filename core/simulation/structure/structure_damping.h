#pragma once

#include <variant>
#include <vector>

#include "core/simulation/structure/structure_model.h"

namespace core::simulation {

// C = M Phi diag(2 zeta w) Phi^T M with the mass-normalised undamped modes Phi (Chopra, Dynamics of Structures, 11.4).
struct ModalDamping {
  std::vector<double> ratio;  // by mode from the lowest; the last holds for all above
};

// C = alpha M + beta K: zeta(w) = alpha / (2 w) + beta w / 2 (Rayleigh 1877).
struct RayleighDamping {
  double alpha_1_s = 0.0, beta_s = 0.0;
};

// A dashpot between each body and the one before it, the first to the ground: not proportional in general.
struct Dashpots {
  std::vector<double> n_s_per_m;  // one for each body; 0 = none there
};

using Damping = std::variant<ModalDamping, RayleighDamping, Dashpots>;

// Replaces the model's damping; mass, stiffness and displacement must be there. Throws std::invalid_argument.
void set_damping(StructureModel& model, const Damping& damping);

}  // namespace core::simulation
