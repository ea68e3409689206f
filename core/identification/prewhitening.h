#pragma once

#include "core/types/cpsd.h"

namespace core {

// How often channels should be differenced before they are identified.
// Once where slow drift makes up most of them (mean over the channels of the share of power below ten cycles per
// segment above one half): a hover drift 20 dB above the modes raises the ridge of the weights above the weak ones.
// Once where modes above half the rate are looked for as well: they are the weak ones, and a difference lifts where
// they stand, just below half the rate, above the lowest. Else not at all: without drift a difference costs a mode far
// below the rate (1.7 Hz at 60 Hz) 8 % of bias in damping, its zero at frequency 0 being one that finitely many block
// rows do not invert.
[[nodiscard]] int choose_differences(const CpsdSums& sums, double max_frequency_hz) noexcept;

}  // namespace core
