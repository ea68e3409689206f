#include "core/spectrum/decimator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/spectrum/kaiser_window.h"

namespace core {

namespace {

constexpr double kStopbandDb = 80.0;
constexpr double kMostMissing = 0.01;  // largest share of missing taps, of the sum of all taps' absolute values
constexpr int kMaxFactor = 1 << 16;

// Kaiser's formulas (Oppenheim & Schafer, Discrete-Time Signal Processing, section 7.5).
const double kBeta = 0.1102 * (kStopbandDb - 8.7);

int half_length(int factor) {
  const double transition = 2.0 * std::numbers::pi * (1.0 - 2.0 * Decimator::kPassband) / factor;
  return static_cast<int>(std::ceil((kStopbandDb - 8.0) / (2.285 * transition) / 2.0));
}

}  // namespace

Decimator::Decimator(int factor) : factor_(factor) {
  if (factor < 1 || factor > kMaxFactor)
    throw std::invalid_argument("Decimator: factor " + std::to_string(factor) + "; 1 .. " + std::to_string(kMaxFactor));
  if (factor == 1) return;
  half_ = half_length(factor);
  taps_.resize(static_cast<std::size_t>(2 * half_ + 1));
  double sum = 0.0;
  for (int k = -half_; k <= half_; ++k) {
    const double x = static_cast<double>(k) / factor;
    const double sinc = k == 0 ? 1.0 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
    const double edge = static_cast<double>(k) / (half_ + 1);
    const double window = kaiser_window(edge, kBeta);
    taps_[static_cast<std::size_t>(k + half_)] = sinc * window;
    sum += sinc * window;
  }
  for (double& tap : taps_) {
    tap /= sum;
    total_weight_ += std::abs(tap);
  }
}

std::vector<double> Decimator::decimate(std::span<const double> record) const {
  if (factor_ == 1) return {record.begin(), record.end()};
  const auto n = static_cast<std::ptrdiff_t>(record.size());
  std::vector<double> out;
  out.reserve(record.size() / static_cast<std::size_t>(factor_) + 1);
  for (std::ptrdiff_t centre = 0; centre < n; centre += factor_) {
    double sum = 0.0;
    double gain = 0.0;
    double weight = 0.0;
    const std::ptrdiff_t last = std::min<std::ptrdiff_t>(half_, n - 1 - centre);
    for (std::ptrdiff_t k = -std::min<std::ptrdiff_t>(half_, centre); k <= last; ++k) {
      const double value = record[static_cast<std::size_t>(centre + k)];
      if (!std::isfinite(value)) continue;
      const double tap = taps_[static_cast<std::size_t>(k + half_)];
      sum += tap * value;
      gain += tap;
      weight += std::abs(tap);
    }
    const bool seen = total_weight_ - weight <= kMostMissing * total_weight_;
    out.push_back(seen ? sum / gain : std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

int decimation_factor(double rate_hz, double max_frequency_hz) noexcept {
  if (!(max_frequency_hz > 0.0) || !(rate_hz > 0.0)) return 1;
  return static_cast<int>(
      std::clamp(std::floor(Decimator::kPassband * rate_hz / max_frequency_hz), 1.0, static_cast<double>(kMaxFactor)));
}

}  // namespace core
