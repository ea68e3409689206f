#pragma once

#include <optional>

#include "core/types/readout.h"

namespace core {

// Chooses the readout time. The declared one is a Gaussian prior (exact where its deviation is 0); tracks and shapes
// are measurements. Those that agree within four of their common standard deviations are combined by inverse variance;
// of two that do not, the more precise one is used, and the finding reports it.
[[nodiscard]] ReadoutFinding choose_readout(const ReadoutValue& declared,
                                            const std::optional<ReadoutValue>& from_tracks,
                                            const std::optional<ReadoutValue>& from_shapes);

}  // namespace core
