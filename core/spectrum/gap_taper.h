#pragma once

#include <cstdint>
#include <span>

namespace core {

// Weights of samples beside gaps. Slow motion of many pixels (hover) that ends at the sharp edge of a gap spreads over
// all frequencies: beside one lost second as much of it lies at 8 Hz as the third mode of a building has. So the weight
// rises over the kLongestTaper samples beside a gap, or as many as the gap is long, as a Hann window does, to 1. Gaps
// of up to kLongestSharp samples are left sharp: bridge_losses.h fills them, or they come so often that nothing would
// be left. seen: 1 or 0; weight: as long, 0 where not seen. A weight multiplies data and mask alike
// (welch_cpsd.h), which keeps correlations unbiased. The ends of the segment are no gaps. False: no gap is longer than
// that, and every weight is that of `seen`.
inline constexpr int kLongestTaper = 16;
inline constexpr int kLongestSharp = 10;
bool gap_weights(std::span<const std::uint8_t> seen, std::span<double> weight) noexcept;

// out = weight (value - mean) window, with those weights. The mean is that of the values seen; beside a long gap, where
// what is left of the mean would spread as drift does, that of the weighted data. All as long; values not seen are 0.
void window_about_mean(std::span<const double> value, std::span<const std::uint8_t> seen,
                       std::span<const double> window, std::span<double> weight, std::span<double> out) noexcept;

}  // namespace core
