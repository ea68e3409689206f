#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "core/identification/mac.h"

namespace core {

// Unit vector along the line through the origin that is nearest to all components, in the direction of the largest.
[[nodiscard]] inline std::complex<double> phase_line(const std::vector<std::complex<double>>& shape) noexcept {
  std::complex<double> squares = 0.0, largest = 0.0;
  for (const auto& z : shape) {
    squares += z * z;
    if (std::norm(z) > std::norm(largest)) largest = z;
  }
  const auto line = std::polar(1.0, 0.5 * std::arg(squares));
  return (std::conj(line) * largest).real() < 0.0 ? -line : line;
}

// The shape with every component replaced by its projection on that line; the largest becomes 1.
[[nodiscard]] inline std::vector<std::complex<double>> along_phase_line(
    const std::vector<std::complex<double>>& shape) {
  const std::complex<double> back = std::conj(phase_line(shape));
  double largest = 0.0;
  for (const auto& z : shape) {
    const double along = (z * back).real();
    if (std::abs(along) > std::abs(largest)) largest = along;
  }
  std::vector<std::complex<double>> out;
  for (const auto& z : shape) out.emplace_back(largest == 0.0 ? 0.0 : (z * back).real() / largest, 0.0);
  return out;
}

// Share of the shape's square beside that line: MPC = (1 - 2 share)^2.
[[nodiscard]] inline double share_beside_line(double mpc) noexcept {
  return 0.5 * (1.0 - std::sqrt(std::clamp(mpc, 0.0, 1.0)));
}

}  // namespace core
