#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/simulation/scene.h"
#include "core/simulation/structure/modal_form.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// What a structure of changing stiffness is given: its modes, the forces on them, and how they stand at time 0.
struct ChangingInput {
  const ModalForm* form = nullptr;
  std::vector<PeriodicSignal> force;   // on each mode
  Eigen::VectorXd position, velocity;  // of the modes at time 0: those of the unchanging structure
  Eigen::RowVectorXd roof;             // displacement of the last body per unit of each mode
  double roof_rms_mm = 0.0;            // of the unchanging structure
  double duration_s = 0.0, rate_hz = 0.0;
};

// z'' + D z' + k(t, z) diag(w^2) z = force with k = (1 + drift (t / T - 1/2))^2 (1 - 4/3 softening x^2 / (2 rms^2)), x
// the last body's displacement to the ground: at an amplitude of sqrt(2) rms the stiffness over a cycle is less by
// `softening`. Runge-Kutta of fourth order, four steps a sample. Samples x modes, from time 0 on, a few beyond the end.
[[nodiscard]] Eigen::MatrixXd integrate_changing(const ChangingInput& input, const ChangeParameters& change);

}  // namespace core::simulation
