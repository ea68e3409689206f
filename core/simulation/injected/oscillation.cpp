#include "core/simulation/injected/oscillation.h"

#include <cmath>
#include <complex>
#include <vector>

namespace core::simulation {

PeriodicSignal oscillation(const OscillatorParameters& oscillator, double rms, RandomStream stream, double duration_s) {
  constexpr double kMargin_s = 60.0, kUpTo = 5.0;  // times its own frequency
  if (rms <= 0.0) return {};
  const double period_s = duration_s + kMargin_s, limit_hz = kUpTo * oscillator.frequency_hz;
  std::vector<std::complex<double>> amplitude(static_cast<std::size_t>(limit_hz * period_s) + 1);
  double variance = 0.0;
  for (std::size_t k = 1; k < amplitude.size(); ++k) {
    const double r = static_cast<double>(k) / period_s / oscillator.frequency_hz;
    const std::complex<double> response = 1.0 / std::complex<double>(1.0 - r * r, 2.0 * oscillator.damping_ratio * r);
    const double re = stream.gaussian();
    amplitude[k] = response * std::complex<double>(re, stream.gaussian());
    variance += std::norm(response);
  }
  for (auto& a : amplitude) a *= rms / std::sqrt(variance);
  return {amplitude, period_s, grid_size(period_s, 20.0 * limit_hz)};
}

}  // namespace core::simulation
