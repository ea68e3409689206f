#pragma once

#include <cstdint>
#include <span>

namespace core {

// Samples lost here and there leave as noise in every lag what their neighbours know of them: a masked sample is a zero
// among 2 px of slow motion, or at the crest of the first mode. So each sample x is split into its best linear
// prediction s from the seen samples around it, itself left out, and the rest; only the rest is lost. With the share p
// of such samples that are lost,
//   y = s + (x - s) / (1 - p) where seen, s where lost,
// has the expectation x at every sample when losses are independent (s does not depend on whether x was seen), whatever
// the weights; what the losses add is nearly white with p / (1 - p) of the variance of x - s instead of that of x.
// s is exact for a line (kriging with a linear trend, Matheron 1969) and else has least squares under the
// autocorrelation of the record itself, the losses in it filled in by s: found in a few rounds, begun with the line
// through the nearest seen samples.
// Gaps of more than kLongestBridge samples stay missing. y and held: as long as x. All samples seen: y is x. Nothing
// allocates; some ten microseconds per sample, spent only where something is lost.
inline constexpr int kLongestBridge = 5;
void bridge_losses(std::span<const double> x, std::span<const std::uint8_t> seen, std::span<double> y,
                   std::span<std::uint8_t> held) noexcept;

}  // namespace core
