#include "core/spectrum/gap_taper.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/spectrum/bridge_losses.h"

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
    if (end - begin <= kLongestBridge) continue;
    is_tapered = true;
    const std::size_t length = std::min<std::size_t>(end - begin, kLongestTaper);
    for (std::size_t k = 1; k <= length; ++k) {
      if (k <= begin) weight[begin - k] = std::min(weight[begin - k], rise(k, length));
      if (end + k <= seen.size()) weight[end + k - 1] = std::min(weight[end + k - 1], rise(k, length));
    }
  }
  return is_tapered;
}

}  // namespace core
