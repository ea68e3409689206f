#pragma once

#include <cmath>
#include <complex>
#include <span>
#include <vector>

namespace core {

// Converts a complex shape to a real one: each component keeps its magnitude; its sign is that of its projection on the
// shape's own phase (the line through the origin nearest to all components). Phases that grow with a channel's delay
// rotate components but keep their magnitudes; the projections themselves would be reduced by the cosine.
[[nodiscard]] inline std::vector<double> real_shape(std::span<const std::complex<double>> shape) {
  std::complex<double> squares = 0.0;
  for (const auto& z : shape) squares += z * z;
  const std::complex<double> towards = std::polar(1.0, 0.5 * std::arg(squares));
  std::vector<double> out;
  for (const auto& z : shape) {
    const double along = z.real() * towards.real() + z.imag() * towards.imag();
    out.push_back(std::copysign(std::abs(z), along));
  }
  // As in the complex shape, the largest component is positive.
  double largest = 0.0;
  for (const double x : out) largest = std::abs(x) > std::abs(largest) ? x : largest;
  for (double& x : out) x = largest < 0.0 ? -x : x;
  return out;
}

// Modal assurance criterion of two shapes after conversion to real ones, 0..1; 0 if one of them is zero.
[[nodiscard]] inline double real_mac(std::span<const std::complex<double>> a, std::span<const std::complex<double>> b) {
  const std::vector<double> x = real_shape(a), y = real_shape(b);
  double inner = 0.0, norm_x = 0.0, norm_y = 0.0;
  for (std::size_t i = 0; i < x.size() && i < y.size(); ++i) {
    inner += x[i] * y[i];
    norm_x += x[i] * x[i];
    norm_y += y[i] * y[i];
  }
  return norm_x > 0.0 && norm_y > 0.0 ? inner * inner / (norm_x * norm_y) : 0.0;
}

}  // namespace core
