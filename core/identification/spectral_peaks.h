#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"
#include "core/types/modal_estimate.h"

namespace core {

inline constexpr std::size_t kMostPeaks = 12;

// Peaks of the sum of all channels' power spectra, ordered by frequency, the highest kMostPeaks: peak picking, with
// each channel's amplitude from the first principal component of the cross-spectra [Brincker, Zhang & Andersen 2001].
// Peaks have no verdict: camera motion, inputs and spectral lines cause peaks, too. channels: of the sums; witnesses
// get no share.
[[nodiscard]] std::vector<SpectralPeak> spectral_peaks(const CpsdSums& sums, const std::vector<ChannelInfo>& channels);

// One over the longest stretch that is analysed: a segment, or the record if it is shorter.
[[nodiscard]] double resolution_hz(const CpsdSums& sums) noexcept;

}  // namespace core
