#pragma once

#include <vector>

#include "core/closure/effects/observation_effect.h"
#include "core/types/closure_result.h"

namespace core::closure {

// All named effects of the observation level.
[[nodiscard]] std::vector<ObservationEffect> observation_effects();

// Effects that no record of tracks can show at this level, whatever their size.
[[nodiscard]] std::vector<NotObservable> never_observable();

}  // namespace core::closure
