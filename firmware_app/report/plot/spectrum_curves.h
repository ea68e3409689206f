#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/report/plot/svg_document.h"

namespace app {

// Is it a spectrum with a segment in it, whose sizes agree?
[[nodiscard]] bool is_drawable(const core::CpsdSums* sums) noexcept;

// One-sided spectral densities over frequency in Hz, from bin 1 on: the segments' means were removed. What is not
// positive is NaN: it has no place on a logarithmic axis. `sums` must be drawable.
[[nodiscard]] std::vector<PlotPoint> density(const core::CpsdSums& sums, int channel);
[[nodiscard]] std::vector<PlotPoint> cross_density(const core::CpsdSums& sums, int i, int j);  // magnitude
[[nodiscard]] std::vector<PlotPoint> total_density(const core::CpsdSums& sums);                // of all channels

// The two channels that share most power, bases aside: whose cross-spectrum tells most. Empty with fewer than two.
[[nodiscard]] std::optional<std::pair<int, int>> strongest_pair(const core::CpsdSums& sums,
                                                                const std::vector<core::ChannelInfo>& channels);

}  // namespace app
