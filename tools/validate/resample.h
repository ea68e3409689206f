#pragma once

#include <vector>

namespace tools {

// Samples at new_rate_hz by a windowed sinc that passes up to 0.44 of the lower rate. The first and the last 0.5 s are
// left out. `values`: no gap.
[[nodiscard]] std::vector<double> resampled(const std::vector<double>& values, double rate_hz, double new_rate_hz);
inline constexpr double kResamplingEdge_s = 0.5;

}  // namespace tools
