#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "firmware_app/report/plot/svg_document.h"

namespace app {

// True if the spectrum contains at least one segment and its sizes agree.
[[nodiscard]] bool is_drawable(const core::CpsdSums* sums) noexcept;

// The sums over it are the one-sided spectral density at that bin.
[[nodiscard]] double density_divisor(const core::CpsdSums& sums, int bin) noexcept;

// One-sided spectral densities over frequency in Hz, from bin 1 on, because the segments' means were removed. Values
// that are not positive become NaN: a logarithmic axis cannot show them. `sums` must be drawable.
[[nodiscard]] std::vector<PlotPoint> density(const core::CpsdSums& sums, int channel);
[[nodiscard]] std::vector<PlotPoint> cross_density(const core::CpsdSums& sums, int i, int j);  // magnitude
[[nodiscard]] std::vector<PlotPoint> total_density(const core::CpsdSums& sums);                // of all channels

// The two channels with the largest common power, bases excluded: their cross-spectrum is shown. Empty with fewer than
// two.
[[nodiscard]] std::optional<std::pair<int, int>> strongest_pair(const core::CpsdSums& sums,
                                                                const std::vector<core::ChannelInfo>& channels);

}  // namespace app
