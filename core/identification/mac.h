#pragma once

#include <complex>
#include <span>

namespace core {

// Modal assurance criterion of two complex shapes, 0..1 (Allemang & Brown 1982); 0 if one of them is zero.
[[nodiscard]] inline double mac(std::span<const std::complex<double>> a,
                                std::span<const std::complex<double>> b) noexcept {
  std::complex<double> inner = 0.0;
  double norm_a = 0.0;
  double norm_b = 0.0;
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    inner += std::conj(a[i]) * b[i];
    norm_a += std::norm(a[i]);
    norm_b += std::norm(b[i]);
  }
  return norm_a > 0.0 && norm_b > 0.0 ? std::norm(inner) / (norm_a * norm_b) : 0.0;
}

// Modal phase collinearity, 1 when all components lie on one line in the complex plane (Juang & Pappa 1986).
[[nodiscard]] inline double mpc(std::span<const std::complex<double>> shape) noexcept {
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;
  for (const auto& z : shape) {
    xx += z.real() * z.real();
    yy += z.imag() * z.imag();
    xy += z.real() * z.imag();
  }
  const double total = xx + yy;
  return total > 0.0 ? ((xx - yy) * (xx - yy) + 4.0 * xy * xy) / (total * total) : 0.0;
}

}  // namespace core
