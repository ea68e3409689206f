#pragma once

#include <vector>

#include "core/types/modal_estimate.h"

namespace core {

// Of two structural modes closer than their half-power widths the one that is less in phase is a mixture with the other
// (a third one folds onto them) if its shape, without its projection on the other's, has an MPC below 0.7; with MAC >
// 0.9, where only noise remains, if its own MPC is below 0.9. It becomes numerical, and its reason says so.
void reject_mixtures(std::vector<Mode>& modes);

// Of two structural modes with MAC > 0.9 within 6 % one that has less than 0.1 % of damping, and less than a third of
// the other's, is a steady force beside it (harmonic). Else the one found in fewer orders is a twin (often an amplitude
// dependence of the same mode): it becomes numerical, and its reason says so.
void reject_twins(std::vector<Mode>& modes);

}  // namespace core
