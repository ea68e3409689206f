#pragma once

#include <cstddef>
#include <vector>

#include "core/types/cpsd.h"

namespace core {

// The sums of some of the channels only, in this order (ascending), blocks included. n_missing is that of all.
[[nodiscard]] CpsdSums select_channels(const CpsdSums& sums, const std::vector<std::size_t>& keep);

}  // namespace core
