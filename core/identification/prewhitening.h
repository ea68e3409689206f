#pragma once

#include "core/types/cpsd.h"

namespace core {

// Number of differences applied to channels before identification. One if slow drift dominates, i.e. if the
// share of power below ten cycles per segment exceeds one half on average over the channels: a hover drift 20
// dB above the modes raises the ridge of the weights above the weak ones. One if modes above half the rate are
// searched for: they are weak, and they often appear just below half the rate, where a difference amplifies
// them relative to the lowest mode. Otherwise none: without drift a difference biases the damping of a mode far
// below the rate (1.7 Hz at 60 Hz) by 8 %, because finitely many block rows do not invert its zero at frequency
// 0.
[[nodiscard]] int choose_differences(const CpsdSums& sums, double max_frequency_hz) noexcept;

}  // namespace core
