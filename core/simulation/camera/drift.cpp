#include "core/simulation/camera/drift.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace core::simulation {

PeriodicSignal drift(const DriftShape& shape, double rms, RandomStream stream, double duration_s, bool integrated) {
  constexpr double kMargin_s = 60.0;
  if (rms <= 0.0) return {};
  const double period_s = 1.5 * duration_s + kMargin_s;
  std::vector<std::complex<double>> amplitude(static_cast<std::size_t>(shape.limit_hz * period_s) + 1);
  double variance = 0.0;
  for (std::size_t k = 1; k < amplitude.size(); ++k) {
    const double f = static_cast<double>(k) / period_s;
    const double density = 1.0 / (1.0 + std::pow(f / shape.corner_hz, shape.order));
    const double re = stream.gaussian();
    amplitude[k] = std::sqrt(density) * std::complex<double>(re, stream.gaussian());
    variance += density;
    if (integrated) amplitude[k] /= std::complex<double>(0.0, 2.0 * std::numbers::pi * f);
  }
  for (auto& a : amplitude) a *= rms / std::sqrt(variance);
  return {amplitude, period_s, grid_size(period_s, 20.0 * shape.limit_hz)};
}

}  // namespace core::simulation
