#include "core/simulation/camera/uniform_spline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace core::simulation {

UniformSpline::UniformSpline(const std::vector<double>& samples, double rate_hz)
    : coefficient_(samples), rate_hz_(rate_hz) {
  const std::size_t n = samples.size();
  if (n < 4 || !(rate_hz > 0.0)) {
    throw std::invalid_argument("spline through " + std::to_string(n) + " samples at " + std::to_string(rate_hz) +
                                " Hz: give at least 4 at a positive rate");
  }
  const double pole = std::sqrt(3.0) - 2.0;
  constexpr std::size_t kForgotten = 40;  // |pole|^40 is below rounding
  std::vector<double>& c = coefficient_;
  double first = 0.0, power = 1.0;
  const std::size_t period = 2 * (n - 1);
  for (std::size_t k = 0; k < kForgotten; ++k, power *= pole) {
    const std::size_t i = k % period;
    first += power * samples[i < n ? i : period - i];
  }
  c[0] = first;
  for (std::size_t k = 1; k < n; ++k) c[k] += pole * c[k - 1];
  c[n - 1] = pole / (pole * pole - 1.0) * (c[n - 1] + pole * c[n - 2]);
  for (std::size_t k = n - 1; k-- > 0;) c[k] = pole * (c[k + 1] - c[k]);
  for (double& value : c) value *= 6.0;
}

double UniformSpline::coefficient(std::ptrdiff_t i) const noexcept {
  const auto last = static_cast<std::ptrdiff_t>(coefficient_.size()) - 1;
  const std::ptrdiff_t mirrored = i < 0 ? -i : i > last ? 2 * last - i : i;
  return coefficient_[static_cast<std::size_t>(mirrored)];
}

double UniformSpline::at(double t_s) const noexcept {
  if (coefficient_.empty() || !std::isfinite(t_s)) return 0.0;
  const double last = static_cast<double>(coefficient_.size() - 1);
  double position = std::abs(t_s * rate_hz_);
  position -= 2.0 * last * std::floor(position / (2.0 * last));
  if (position > last) position = 2.0 * last - position;
  const double cell = std::min(std::floor(position), last - 1.0);
  const auto i = static_cast<std::ptrdiff_t>(cell);
  const double x = position - cell, y = 1.0 - x;
  const double far_left = y * y * y / 6.0, far_right = x * x * x / 6.0;
  const double left = 2.0 / 3.0 - 0.5 * x * x * (2.0 - x), right = 2.0 / 3.0 - 0.5 * y * y * (2.0 - y);
  return far_left * coefficient(i - 1) + left * coefficient(i) + right * coefficient(i + 1) +
         far_right * coefficient(i + 2);
}

}  // namespace core::simulation
