#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace core {

// One of several measurements of one quantity.
struct Measured {
  double value = 0.0;
  double std = 0.0;                 // > 0
  double degrees_of_freedom = 0.0;  // of std; 0 = std is exact
};

struct WeightedMean {
  double value = 0.0;
  double std = 0.0;                 // 0 = unknown
  double degrees_of_freedom = 0.0;  // of std; 0 = exact or unknown
  // Observed scatter of the measurements about their mean over the scatter expected from their standard deviations,
  // rms: about 1 if these are right and the quantity did not change. Empty: fewer than two.
  std::optional<double> scatter;
  std::size_t n = 0;
};

// Mean weighted by 1 / std^2, and its standard deviation. Uncertain weights increase the variance by 1 + 4 sum p (1 -
// p) / nu, with p a measurement's share of the weights and nu its degrees of freedom (Meier 1953, Variance of a
// weighted mean). If the measurements scatter more than their standard deviations imply, the standard deviation of the
// mean is computed from their scatter (Birge 1932). Summed in the order given.
[[nodiscard]] WeightedMean inverse_variance_mean(std::span<const Measured> measured);

}  // namespace core
