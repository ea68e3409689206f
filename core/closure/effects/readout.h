#pragma once

#include "core/closure/effects/observation_effect.h"

namespace core::closure {

[[nodiscard]] ObservationEffect readout_effect();

}  // namespace core::closure
