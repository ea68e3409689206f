#pragma once

#include <vector>

#include "core/types/modal_estimate.h"

namespace core {

// A peak that noise has by chance is fitted by a pole, too. Such a pole is missing in some of the model orders, and its
// frequency is known worse than that of a mode: a mode (structural, or of open alias order) that is missing in an order
// and whose sigma of the frequency exceeds 2.75 times the least one (least_variances()) becomes numerical, and its
// reason says so. Without a sigma a mode stays, unless it is late (is_late() of verdict.h): then the sigma is what
// makes it a mode, or a candidate. is_late[i] belongs to modes[i]. duration_s: of the record that is remembered.
void reject_chance_poles(const std::vector<bool>& is_late, double duration_s, std::vector<Mode>& modes);

// What is left of them in every order: a mode whose frequency is known to a tenth of itself at best becomes numerical.
// (The sigma of one that drifts may be many times the least one.) For the final list: an estimate that is replaced
// later may know its modes badly (identify_shared()).
void reject_vague_modes(std::vector<Mode>& modes);
// The same in an estimate, whose rejected poles then list it.
void reject_vague_modes(ModalEstimate& estimate);

}  // namespace core
