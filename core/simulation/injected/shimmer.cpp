#include "core/simulation/injected/shimmer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

constexpr std::size_t kWaves = 192, kSteps = 4096;

// Cumulative variance of the shift over the length of the wave vector, 0 .. 3 km.
std::vector<double> cumulated(double k0, double km) {
  std::vector<double> sum(kSteps + 1, 0.0);
  for (std::size_t i = 1; i <= kSteps; ++i) {
    const double k = 3.0 * km * (static_cast<double>(i) - 0.5) / static_cast<double>(kSteps);
    sum[i] = sum[i - 1] + k * k * k * std::pow(k * k + k0 * k0, -11.0 / 6.0) * std::exp(-(k / km) * (k / km));
  }
  return sum;
}

}  // namespace

Shimmer::Shimmer(const ShimmerParameters& p, std::uint64_t seed) {
  if (p.rms_px <= 0.0) return;
  const double k0 = 2.0 * std::numbers::pi / p.outer_px, km = 5.92 / p.inner_px;
  const std::vector<double> sum = cumulated(k0, km);
  RandomStream stream(seed, "shimmer");
  // Gradient of a screen: each wave shifts along its own vector, a quarter of its squared amplitude per axis.
  const double amplitude_px = p.rms_px * 2.0 / std::sqrt(static_cast<double>(kWaves));
  for (std::size_t i = 0; i < kWaves; ++i) {
    const double wanted = stream.uniform() * sum.back();
    const auto at = static_cast<double>(std::upper_bound(sum.begin(), sum.end(), wanted) - sum.begin()) - 0.5;
    const double k = 3.0 * km * at / static_cast<double>(kSteps);
    const double angle = 2.0 * std::numbers::pi * stream.uniform();
    const double ku = k * std::cos(angle), kv = k * std::sin(angle);
    const double drift_u = p.drift_px_s[0] + p.boiling_px_s * stream.gaussian();
    const double drift_v = p.drift_px_s[1] + p.boiling_px_s * stream.gaussian();
    const double phase = 2.0 * std::numbers::pi * stream.uniform();
    waves_.push_back(
        {ku, kv, ku * drift_u + kv * drift_v, phase, amplitude_px * std::cos(angle), amplitude_px * std::sin(angle)});
  }
}

Shimmer::Shift Shimmer::at(double u_px, double v_px, double t_s) const noexcept {
  Shift shift;
  for (const Wave& wave : waves_) {
    const double height = std::sin(wave.ku * u_px + wave.kv * v_px - wave.w * t_s + wave.phase);
    shift.u_px += wave.shift_u * height;
    shift.v_px += wave.shift_v * height;
  }
  return shift;
}

}  // namespace core::simulation
