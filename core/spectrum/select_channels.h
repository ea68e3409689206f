#pragma once

#include <cstddef>
#include <vector>

#include "core/types/cpsd.h"

namespace core {

// The sums of a subset of the channels, in this order (ascending), blocks included. n_missing is that of all channels.
[[nodiscard]] CpsdSums select_channels(const CpsdSums& sums, const std::vector<std::size_t>& keep);

}  // namespace core
