#pragma once

#include "core/simulation/injected/parameters.h"
#include "core/simulation/random_stream.h"
#include "core/simulation/structure/periodic_signal.h"

namespace core::simulation {

// Response of the oscillator to white noise, scaled to standard deviation `rms`; zero if rms is 0.
[[nodiscard]] PeriodicSignal oscillation(const OscillatorParameters& oscillator, double rms, RandomStream stream,
                                         double duration_s);

}  // namespace core::simulation
