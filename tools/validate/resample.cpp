#include "tools/validate/resample.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace tools {
namespace {

double sinc(double x) { return std::abs(x) < 1e-12 ? 1.0 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

}  // namespace

std::vector<double> resampled(const std::vector<double>& values, double rate_hz, double new_rate_hz) {
  const double cutoff_hz = 0.47 * std::min(rate_hz, new_rate_hz);
  const double duration_s = static_cast<double>(values.size()) / rate_hz;
  const auto reach = static_cast<std::ptrdiff_t>(kResamplingEdge_s * rate_hz);
  std::vector<double> out;
  for (std::size_t k = 0;; ++k) {
    const double t_s = kResamplingEdge_s + static_cast<double>(k) / new_rate_hz;
    if (t_s > duration_s - kResamplingEdge_s - 1.0 / rate_hz) return out;
    const auto middle = static_cast<std::ptrdiff_t>(std::llround(t_s * rate_hz));
    double sum = 0.0, weights = 0.0;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, middle - reach);
         i <= middle + reach && i < static_cast<std::ptrdiff_t>(values.size()); ++i) {
      const double away_s = static_cast<double>(i) / rate_hz - t_s;
      if (std::abs(away_s) >= kResamplingEdge_s) continue;
      const double weight =
          sinc(2.0 * cutoff_hz * away_s) * (0.5 + 0.5 * std::cos(std::numbers::pi * away_s / kResamplingEdge_s));
      sum += weight * values[static_cast<std::size_t>(i)];
      weights += weight;
    }
    out.push_back(sum / weights);
  }
}

}  // namespace tools
