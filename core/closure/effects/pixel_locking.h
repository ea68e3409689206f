#pragma once

#include "core/closure/effects/observation_effect.h"

namespace core::closure {

[[nodiscard]] ObservationEffect pixel_locking_effect();

}  // namespace core::closure
