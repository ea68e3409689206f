#include "core/spectrum/kaiser_window.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

// Modified Bessel function of the first kind, order 0: sum over k of ((x / 2)^k / k!)^2 (Abramowitz & Stegun 9.6.12).
// All terms are positive, so there is no cancellation.
double bessel_i0(double x) noexcept {
  const double quarter = 0.25 * x * x;
  double term = 1.0, sum = 1.0;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= quarter / (static_cast<double>(k) * k);
    sum += term;
  }
  return sum;
}

}  // namespace

double kaiser_window(double edge, double beta) noexcept {
  return bessel_i0(beta * std::sqrt(std::max(0.0, 1.0 - edge * edge))) / bessel_i0(beta);
}

}  // namespace core
