#include "core/spectrum/gap_taper.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace core {

namespace {

// Of the sample `distance` away from the gap, 1 the next to it.
double rise(std::size_t distance, std::size_t length) noexcept {
  const double share = static_cast<double>(distance) / static_cast<double>(length + 1);
  return std::pow(std::sin(0.5 * std::numbers::pi * share), 2);
}

}  // namespace

bool gap_weights(std::span<const std::uint8_t> seen, std::span<double> weight) noexcept {
  std::fill(weight.begin(), weight.end(), 1.0);
  bool is_tapered = false;
  for (std::size_t begin = 0, end = 0; begin < seen.size(); begin = end + 1) {
    while (begin < seen.size() && seen[begin] != 0) ++begin;
    if (begin == seen.size()) break;
    for (end = begin; end < seen.size() && seen[end] == 0; ++end) weight[end] = 0.0;
    if (end - begin <= kLongestSharp) continue;
    is_tapered = true;
    const std::size_t length = std::min<std::size_t>(end - begin, kLongestTaper);
    for (std::size_t k = 1; k <= length; ++k) {
      if (k <= begin) weight[begin - k] = std::min(weight[begin - k], rise(k, length));
      if (end + k <= seen.size()) weight[end + k - 1] = std::min(weight[end + k - 1], rise(k, length));
    }
  }
  return is_tapered;
}

void window_about_mean(std::span<const double> value, std::span<const std::uint8_t> seen,
                       std::span<const double> window, std::span<double> weight, std::span<double> out) noexcept {
  const bool is_tapered = gap_weights(seen, weight);
  double sum = 0.0, count = 0.0;
  for (std::size_t t = 0; t < value.size(); ++t) {
    const double share = is_tapered ? weight[t] * window[t] : weight[t];
    sum += share * value[t];
    count += share;
  }
  const double mean = count > 0.0 ? sum / count : 0.0;
  for (std::size_t t = 0; t < value.size(); ++t) out[t] = weight[t] * (value[t] - mean) * window[t];
}

}  // namespace core
