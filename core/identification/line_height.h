#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/linear/median.h"
#include "core/types/cpsd.h"

namespace core {

// A line lies within kLineReach_hz of its centre; it is compared with the spectrum from there to kLineBeside_hz. Below
// kSlowestBeside_hz the hover drift dominates.
inline constexpr double kLineReach_hz = 1.0, kLineBeside_hz = 3.0, kSlowestBeside_hz = 0.4;
// Bins of the zero-padded spectrum, to either side, that are averaged before: the main lobe of a segment.
inline constexpr int kLineSmoothing = 4;

// Independent values that the mean at one bin holds.
[[nodiscard]] inline double values_per_bin(const CpsdSums& sums) noexcept {
  constexpr double kBinsPerValue = 2.6;
  return (2 * kLineSmoothing + 1) / kBinsPerValue * std::max(1.0, sums.weight.effective());
}

// First and last of the bins that are averaged for one.
[[nodiscard]] inline std::pair<int, int> smoothing_at(int bin, int n_bins) noexcept {
  return {std::max(0, bin - kLineSmoothing), std::min(n_bins - 1, bin + kLineSmoothing)};
}

// Every bin of a smoothed spectrum over the level beside it, the geometric mean of the medians on both sides: on the
// slope of the hover drift the level is too high rather than too low. Near half the rate the lower side alone; 0 where
// there is no lower side.
[[nodiscard]] inline std::vector<double> heights(const std::vector<double>& smooth, double hz_per_bin) {
  constexpr int kFewest = 8;  // bins of a side
  const auto bins = [&](double hz) { return static_cast<int>(hz / hz_per_bin); };
  const auto beside = [&](int first, int last) {
    first = std::max(first, bins(kSlowestBeside_hz)), last = std::min(last, static_cast<int>(smooth.size()));
    return last - first < kFewest ? 0.0 : median({smooth.begin() + first, smooth.begin() + last});
  };
  const int near = bins(kLineReach_hz), far = bins(kLineBeside_hz);
  std::vector<double> out;
  for (int bin = 0; bin < static_cast<int>(smooth.size()); ++bin) {
    const double below = beside(bin - far, bin - near), above = beside(bin + near + 1, bin + far + 1);
    const double level = above > 0.0 ? std::sqrt(below) * std::sqrt(above) : below;
    out.push_back(below > 0.0 ? smooth[static_cast<std::size_t>(bin)] / level : 0.0);
  }
  return out;
}

}  // namespace core
