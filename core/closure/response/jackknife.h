#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/types/closure_result.h"

namespace core::closure {

// Standard deviations from estimates that each leave out one part of the record (delete-one jackknife, Quenouille
// 1956): valid for coloured residuals and any estimator. `without[k]` has the order of `whole`.
inline void add_jackknife_sigmas(std::vector<ParameterValue>& whole,
                                 const std::vector<std::vector<ParameterValue>>& without) {
  const auto n = static_cast<double>(without.size());
  if (without.size() < 2) return;
  for (std::size_t p = 0; p < whole.size(); ++p) {
    double mean = 0.0, squares = 0.0;
    for (const auto& one : without) mean += one[p].value / n;
    for (const auto& one : without) squares += (one[p].value - mean) * (one[p].value - mean);
    const double sigma = std::sqrt(squares * (n - 1.0) / n);
    if (std::isfinite(sigma)) whole[p].sigma = sigma;
  }
}

}  // namespace core::closure
