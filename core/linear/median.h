#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace core {

// Of an even number of values the upper one; NaN without values. Reorders the values; does not allocate.
[[nodiscard]] inline double median_in_place(std::span<double> values) noexcept {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Standard deviation of a Gaussian over its median absolute deviation.
inline constexpr double kSigmaPerMad = 1.4826;

[[nodiscard]] inline double median(std::vector<double> values) { return median_in_place(values); }

}  // namespace core
