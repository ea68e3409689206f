#pragma once

#include "core/types/cpsd.h"

namespace core {

// How often channels should be differenced before they are identified: once where slow drift makes up most of them
// (mean over the channels of the share of power below ten cycles per segment above one half), else not at all. A hover
// drift 20 dB above the modes raises the ridge of the weights above the weak ones; without drift a difference costs the
// lowest mode: its zero at frequency 0 is one that finitely many block rows do not invert.
[[nodiscard]] int choose_differences(const CpsdSums& sums) noexcept;

}  // namespace core
