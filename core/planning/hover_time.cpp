#include "core/planning/hover_time.h"

#include <algorithm>
#include <cmath>

#include "core/types/constants.h"

namespace core::planning {

constexpr double kMethodVariance = kMethodFactor * kMethodFactor;

double relative_frequency_sigma(double frequency_hz, double damping_ratio, double duration_s) noexcept {
  return kMethodFactor * std::sqrt(damping_ratio / (kTwoPi * frequency_hz * duration_s));
}

double relative_damping_sigma(double frequency_hz, double damping_ratio, double duration_s) noexcept {
  return kMethodFactor / std::sqrt(kTwoPi * damping_ratio * frequency_hz * duration_s);
}

double seconds_for_frequency(double frequency_hz, double damping_ratio, double relative_sigma) noexcept {
  return kMethodVariance * damping_ratio / (kTwoPi * frequency_hz * relative_sigma * relative_sigma);
}

double seconds_for_damping(double frequency_hz, double damping_ratio, double relative_sigma) noexcept {
  return kMethodVariance / (kTwoPi * damping_ratio * frequency_hz * relative_sigma * relative_sigma);
}

int segment_length(double slowest_hz, double damping_ratio, double rate_hz, double duration_s) noexcept {
  constexpr int kShortest = 64, kLongest = 1 << 20;  // spectrum.segment takes no more
  const double wanted = 2.0 * rate_hz / (kTwoPi * damping_ratio * slowest_hz);
  const double most = 0.25 * rate_hz * duration_s;
  int segment = kShortest;
  while (segment < wanted && 2 * segment <= most && segment < kLongest) segment *= 2;
  return segment;
}

}  // namespace core::planning
