#pragma once

#include <cstdint>
#include <span>

namespace core {

// Samples lost here and there leave slow motion, which the neighbours know, as noise in every lag: a masked sample is a
// zero among 2 px. So each sample x is split into the line s through the nearest seen neighbours before and after it,
// itself left out, and the rest; only the rest is lost. With the share p of such samples that are lost,
//   y = s + (x - s) / (1 - p) where seen, s where lost,
// has the expectation x at every sample when losses are independent (s does not depend on whether x was seen), whatever
// the frequency; what the losses add is white with p / (1 - p) of the variance of x - s instead of that of x.
// Gaps of more than kLongestBridge samples stay missing. y and held: as long as x. All samples seen: y is x.
inline constexpr int kLongestBridge = 5;
void bridge_losses(std::span<const double> x, std::span<const std::uint8_t> seen, std::span<double> y,
                   std::span<std::uint8_t> held) noexcept;

}  // namespace core
