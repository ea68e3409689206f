#include "core/simulation/injected/gimbal_vibration.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "core/simulation/random_stream.h"

namespace core::simulation {
namespace {

using Amplitudes = std::vector<std::complex<double>>;
constexpr double kMargin_s = 60.0, kWidths = 5.0;

// Unit variance.
Amplitudes band(const VibrationParameters& p, RandomStream stream, double period_s) {
  Amplitudes amplitude(static_cast<std::size_t>((p.centre_hz + kWidths * p.width_hz) * period_s) + 1);
  double variance = 0.0;
  for (std::size_t k = 1; k < amplitude.size(); ++k) {
    const double off = (static_cast<double>(k) / period_s - p.centre_hz) / p.width_hz;
    const double density = std::exp(-0.5 * off * off), re = stream.gaussian();
    amplitude[k] = std::sqrt(density) * std::complex<double>(re, stream.gaussian());
    variance += density;
  }
  for (auto& a : amplitude) a /= std::sqrt(variance);
  return amplitude;
}

}  // namespace

GimbalVibration::GimbalVibration(const VibrationParameters& p, std::uint64_t seed, double duration_s) {
  const double period_s = duration_s + kMargin_s, highest_hz = p.centre_hz + kWidths * p.width_hz;
  const Amplitudes common = band(p, RandomStream(seed, "vibration"), period_s);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const double rms = axis < 3 ? p.rms_mm[axis] : p.rms_rad[axis - 3];
    if (rms <= 0.0) continue;
    const double phase = 2.0 * std::numbers::pi * RandomStream(seed, "vibration_phase", axis).uniform();
    Amplitudes own = band(p, RandomStream(seed, "vibration_own", axis), period_s);
    for (std::size_t k = 0; k < own.size(); ++k)
      own[k] = rms * std::sqrt(0.5) * (own[k] + std::polar(1.0, phase) * common[k]);
    axis_[axis] = PeriodicSignal(own, period_s, grid_size(period_s, 20.0 * highest_hz));
  }
}

}  // namespace core::simulation
