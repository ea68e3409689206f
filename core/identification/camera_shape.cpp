#include "core/identification/camera_shape.h"

#include "core/types/constants.h"

namespace core {

// Complex least squares; centring makes constant and slope orthogonal.
double camera_share(const std::vector<std::complex<double>>& observed, double frequency_hz,
                    const std::vector<double>& delay_s) {
  const auto n = static_cast<double>(observed.size());
  double mean_delay = 0.0;
  for (const double delay : delay_s) mean_delay += delay / n;
  std::complex<double> constant = 0.0, slope = 0.0;
  double slopes = 0.0, whole = 0.0;
  for (std::size_t c = 0; c < observed.size(); ++c) {
    const double x = delay_s[c] - mean_delay;
    const std::complex<double> undelayed = observed[c] * std::polar(1.0, -kTwoPi * frequency_hz * delay_s[c]);
    constant += undelayed;
    slope += x * undelayed;
    slopes += x * x;
    whole += std::norm(undelayed);
  }
  if (!(whole > 0.0 && slopes > 0.0)) return 0.0;
  return (std::norm(constant) / n + std::norm(slope) / slopes) / whole;
}

double phase_likeness(double apart_hz, const std::vector<double>& delay_s) {
  std::complex<double> sum = 0.0;
  for (const double delay : delay_s) sum += std::polar(1.0, kTwoPi * apart_hz * delay);
  return std::abs(sum) / static_cast<double>(delay_s.size());
}

}  // namespace core
