#pragma once

#include <vector>

#include "core/identification/mode_sigmas.h"
#include "core/types/modal_estimate.h"

namespace core {

// Chance puts a part of a shape's square beside its line (ModeScatter::beside_line). A shape is in phase within chance
// if no more than 3.5 times that part lies there. Chance is no explanation where the frequency is not known to a
// quarter of the half-power width: such a pole may have any phases. modes[i] belongs to sigmas.scatter[i].

// A mode that holds so far and is not in phase within chance becomes numerical with an MPC below `min_mpc`, and
// ambiguous if it is folded and its MPC is below 0.85: the alias order depends on the phases.
void reject_out_of_phase(double min_mpc, const Sigmas& sigmas, std::vector<Mode>& modes);

// A shape in phase within chance is stated along its line (phase_line.h), with the sigmas of that. Returns which ones
// are.
std::vector<bool> state_along_line(const Sigmas& sigmas, std::vector<Mode>& modes);

}  // namespace core
