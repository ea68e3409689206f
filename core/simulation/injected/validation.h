#pragma once

#include "core/simulation/scene.h"

namespace core::simulation {

// Ranges of the effects of this folder. Throws std::invalid_argument: what, its value, what to give.
void validate_injected(const Scene& scene);

}  // namespace core::simulation
