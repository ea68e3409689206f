#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace core::closure {

inline constexpr std::array<double, 3> kSpreadShares{0.16, 0.5, 0.84};  // a median and one sigma to either side

// First bins at which the cumulative power reaches these shares of the whole (ascending, below 1); power.size() where
// noise subtracted from the power leaves less.
template <std::size_t kShares>
[[nodiscard]] std::array<Eigen::Index, kShares> power_quantiles(const Eigen::VectorXd& power,
                                                                const std::array<double, kShares>& shares) {
  std::array<Eigen::Index, kShares> out{};
  out.fill(power.size());
  const double whole = power.sum();
  double sum = 0.0;
  std::size_t reached = 0;
  for (Eigen::Index b = 0; b < power.size(); ++b) {
    sum += power(b);
    while (reached < kShares && sum >= shares[reached] * whole) out[reached++] = b;
  }
  return out;
}

}  // namespace core::closure
