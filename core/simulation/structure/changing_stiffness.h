#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/simulation/scene.h"
#include "core/simulation/structure/modal_form.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// Input of a structure with changing stiffness: its modes, the forces on them, and their state at time 0.
struct ChangingInput {
  const ModalForm* form = nullptr;
  std::vector<PeriodicSignal> force;   // on each mode
  Eigen::VectorXd position, velocity;  // of the modes at time 0: those of the unchanged structure
  Eigen::RowVectorXd roof;             // displacement of the last body per unit of each mode
  double roof_rms_mm = 0.0;            // of the unchanged structure
  double duration_s = 0.0, rate_hz = 0.0;
};

// z'' + D z' + k(t, z) diag(w^2) z = force with k = (1 + drift (t / T - 1/2))^2 (1 - 4/3 softening x^2 / (2 rms^2)), x
// the last body's displacement relative to the ground: at an amplitude of sqrt(2) rms the mean stiffness over a cycle
// is lower by `softening`. Runge-Kutta of fourth order, four steps per sample. Samples x modes, from time 0 to slightly
// beyond the end.
[[nodiscard]] Eigen::MatrixXd integrate_changing(const ChangingInput& input, const ChangeParameters& change);

}  // namespace core::simulation
