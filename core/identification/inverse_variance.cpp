#include "core/identification/inverse_variance.h"

#include <algorithm>
#include <cmath>

namespace core {

namespace {

double weight(const Measured& m) { return 1.0 / (m.std * m.std); }

// Expectation of (x - mean)^2 / std^2 for an estimated std: the variance of Student's t, which exists above two degrees
// of freedom and is too uncertain below four.
double expected_square(const Measured& m) {
  if (m.degrees_of_freedom <= 0.0) return 1.0;
  const double nu = std::max(m.degrees_of_freedom, 4.0);
  return nu / (nu - 2.0);
}

}  // namespace

WeightedMean inverse_variance_mean(std::span<const Measured> measured) {
  WeightedMean mean;
  mean.n = measured.size();
  if (measured.empty()) return mean;
  double total = 0.0;
  for (const Measured& m : measured) total += weight(m);
  // Relative to the first value, so that the mean of a single value is exact.
  const double origin = measured.front().value;
  double offset = 0.0, price = 1.0, per_degree = 0.0;
  for (const Measured& m : measured) {
    const double share = weight(m) / total;
    offset += share * (m.value - origin);
    if (m.degrees_of_freedom <= 0.0) continue;
    price += 4.0 * share * (1.0 - share) / m.degrees_of_freedom;
    per_degree += share * share / m.degrees_of_freedom;
  }
  mean.value = origin + offset;
  mean.std = std::sqrt(price / total);
  mean.degrees_of_freedom = per_degree > 0.0 ? 1.0 / per_degree : 0.0;
  if (measured.size() < 2) {
    mean.std = measured.front().std;
    return mean;
  }
  double squares = 0.0, expected = 0.0;
  for (const Measured& m : measured) {
    const double apart = m.value - mean.value;
    squares += weight(m) * apart * apart;
    expected += (1.0 - weight(m) / total) * expected_square(m);
  }
  if (!(expected > 0.0)) return mean;
  mean.scatter = std::sqrt(squares / expected);
  mean.std *= std::max(1.0, *mean.scatter);
  return mean;
}

}  // namespace core
