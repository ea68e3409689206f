#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace core {

// One of several measurements of the same quantity.
struct Measured {
  double value = 0.0;
  double std = 0.0;                 // > 0
  double degrees_of_freedom = 0.0;  // behind std; 0 = it is exact
};

struct WeightedMean {
  double value = 0.0;
  double std = 0.0;                 // 0 = not known
  double degrees_of_freedom = 0.0;  // behind std; 0 = it is exact, or not known
  // Scatter of the measurements about their mean over the one expected from their standard deviations, rms: about 1 if
  // these are right and the quantity did not change. Empty: fewer than two.
  std::optional<double> scatter;
  std::size_t n = 0;
};

// Mean weighted by 1 / std^2, and its standard deviation. Uncertain weights cost precision: a factor 1 + 4 sum p (1 -
// p) / nu in variance, p a measurement's share of the weights, nu its degrees of freedom (Meier 1953, Variance of a
// weighted mean). Where the measurements scatter more than stated, the standard deviation is that of their scatter
// (Birge 1932). Summed in the order given.
[[nodiscard]] WeightedMean inverse_variance_mean(std::span<const Measured> measured);

}  // namespace core
