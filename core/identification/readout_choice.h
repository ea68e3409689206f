#pragma once

#include <optional>

#include "core/types/readout.h"

namespace core {

// Which readout time to use. What is declared is a prior of Gaussian scatter (exact where its deviation is 0); tracks
// and shapes are measurements. Those that agree within four of their common standard deviations are combined by inverse
// variance; of two that do not, the better known one stands, and the finding says so.
[[nodiscard]] ReadoutFinding choose_readout(const ReadoutValue& declared,
                                            const std::optional<ReadoutValue>& from_tracks,
                                            const std::optional<ReadoutValue>& from_shapes);

}  // namespace core
