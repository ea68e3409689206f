#pragma once

#include "core/simulation/scene.h"

namespace core::simulation {

// Checks the ranges of the effects of this folder. Throws std::invalid_argument with the value and a remedy.
void validate_injected(const Scene& scene);

}  // namespace core::simulation
