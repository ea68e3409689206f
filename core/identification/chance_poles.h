#pragma once

#include <vector>

#include "core/types/modal_estimate.h"

namespace core {

// A peak that noise has by chance is fitted by a pole, too. Such a pole is missing in some of the model orders, and its
// frequency is known worse than that of a mode: a structural mode, or one of open alias order, that is missing in an
// order and whose sigma of the frequency exceeds 2.75 times the least one (least_variances()) becomes numerical, and
// its reason says so. Modes without a sigma stay. duration_s: of the record that is remembered.
void reject_chance_poles(double duration_s, std::vector<Mode>& modes);

}  // namespace core
