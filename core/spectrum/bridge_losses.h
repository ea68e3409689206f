#pragma once

#include <cstdint>
#include <span>

namespace core {

// Fills short gaps without bias. A masked sample acts as noise in every lag, although its neighbours determine most of
// it: it is a zero within 2 px of slow motion, or at the crest of the first mode. Each sample x is therefore split into
// its best linear prediction s from the observed samples around it, itself excluded, and a remainder; only the
// remainder is lost. With the share p of such samples that are lost,
//   y = s + (x - s) / (1 - p) where observed, s where lost,
// has the expectation x at every sample if losses are independent (s does not depend on whether x was observed),
// whatever the weights. The losses add nearly white noise of p / (1 - p) times the variance of x - s instead of that
// of x. s is exact for a line (kriging with a linear trend, Matheron 1969) and otherwise a least-squares predictor for
// the autocorrelation of the record itself, with losses filled by s: a few iterations, starting from the line
// through the nearest observed samples.
// Gaps of more than kLongestBridge samples stay missing. y and held: as long as x. If all samples are observed, y is x.
// Does not allocate; some forty microseconds per sample, only where a sample is lost.
inline constexpr int kLongestBridge = 31;
void bridge_losses(std::span<const double> x, std::span<const std::uint8_t> seen, std::span<double> y,
                   std::span<std::uint8_t> held) noexcept;

}  // namespace core
