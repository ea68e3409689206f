#pragma once

#include "core/identification/correlation.h"

namespace test_support {

// a + share (b - a): between the correlations of two systems.
inline core::Correlations mixed_correlations(const core::Correlations& a, const core::Correlations& b, double share) {
  core::Correlations out(a.n_channels(), a.max_lag());
  for (int i = 0; i < a.n_channels(); ++i) {
    for (int j = i; j < a.n_channels(); ++j) {
      for (int lag = -a.max_lag(); lag <= a.max_lag(); ++lag) {
        const double value = a.divided(i, j, lag) + share * (b.divided(i, j, lag) - a.divided(i, j, lag));
        out.set(i, j, lag, value, value);
      }
    }
  }
  return out;
}

}  // namespace test_support
