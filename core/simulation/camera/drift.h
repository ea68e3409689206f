#pragma once

#include "core/simulation/random_stream.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// One-sided density ~ 1 / (1 + (f / corner)^order) up to limit_hz.
struct DriftShape {
  double corner_hz = 0.0, order = 6.0, limit_hz = 0.0;
};

// A Gaussian process of that density and standard deviation `rms`; its period exceeds the clip, so that correlations
// have decayed before it repeats. `integrated`: its integral over time instead (zero mean).
[[nodiscard]] PeriodicSignal drift(const DriftShape& shape, double rms, RandomStream stream, double duration_s,
                                   bool integrated = false);

}  // namespace core::simulation
