#pragma once

#include <optional>

#include "core/types/readout.h"

namespace core {

// Chooses the readout time. The declared one is a Gaussian prior (exact if its standard deviation is 0); estimates from
// tracks and shapes are measurements. Values that agree within four of their common standard deviations are combined by
// inverse variance. If two disagree, the more precise one is used. A declared value that measurements contradict by
// more than four of their common standard deviations, 1 % of the measured value for an undeclared lens included, gives
// way even if it is declared as more precise, unless it is exact. The finding reports the contradiction.
[[nodiscard]] ReadoutFinding choose_readout(const ReadoutValue& declared,
                                            const std::optional<ReadoutValue>& from_tracks,
                                            const std::optional<ReadoutValue>& from_shapes);

}  // namespace core
