#include "core/planning/ideal_shape.h"

#include <algorithm>
#include <cmath>

#include "core/planning/check_value.h"
#include "core/types/constants.h"

namespace core::planning {
namespace {

// Root of cos b + 1 / cosh b = 0 near (r - 1/2) pi; Newton's method converges to rounding in a few steps.
double cantilever_root(int number) noexcept {
  double b = number == 1 ? 1.875 : (number - 0.5) * kPi;
  for (int i = 0; i < 8; ++i) {
    const double value = std::cos(b) + 1.0 / std::cosh(b);
    const double slope = -std::sin(b) - std::tanh(b) / std::cosh(b);
    b -= value / slope;
  }
  return b;
}

// The growing and the decaying exponential are separate: cosh - k sinh loses all digits from the fifth mode on.
double cantilever(double b, double x) noexcept {
  const double divisor = std::sinh(b) + std::sin(b);
  const double k = (std::cosh(b) + std::cos(b)) / divisor;
  const double one_minus_k = (std::sin(b) - std::cos(b) - std::exp(-b)) / divisor;
  const double growing = 0.5 * one_minus_k * std::exp(b * x);
  const double decaying = 0.5 * (1.0 + k) * std::exp(-b * x);
  return growing + decaying - std::cos(b * x) + k * std::sin(b * x);
}

void scale_to_one(std::vector<double>& shape) noexcept {
  double largest = 0.0;
  for (const double value : shape) largest = std::abs(value) > std::abs(largest) ? value : largest;
  if (largest == 0.0) return;
  for (double& value : shape) value /= largest;
}

}  // namespace

std::vector<double> ideal_shape(StructureKind kind, int number, const std::vector<double>& positions, int n_floors) {
  require_range("number of the mode", number, 1, kind == StructureKind::kShearChain ? n_floors : 40);
  const double b = kind == StructureKind::kCantilever ? cantilever_root(number) : 0.0;
  std::vector<double> shape;
  for (const double x : positions) {
    require_range("position along the structure (1 = its end)", x, 0.0, 1.0);
    switch (kind) {
      case StructureKind::kShearChain:
        shape.push_back(std::sin((2 * number - 1) * x * n_floors * kPi / (2 * n_floors + 1)));
        break;
      case StructureKind::kCantilever:
        shape.push_back(cantilever(b, x));
        break;
      case StructureKind::kBeam:
        shape.push_back(std::sin(number * kPi * x));
        break;
    }
  }
  scale_to_one(shape);
  return shape;
}

}  // namespace core::planning
