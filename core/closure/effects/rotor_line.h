#pragma once

#include "core/closure/effects/observation_effect.h"

namespace core::closure {

[[nodiscard]] ObservationEffect rotor_line_effect();

}  // namespace core::closure
