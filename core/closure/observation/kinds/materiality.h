#pragma once

#include "core/closure/observation/fit_view.h"

namespace core::closure {

// Materiality thresholds of the observation level: smallest gain per residual value, in noise variances. The model's
// own error does not reach them (core/closure/METHOD.md).
inline constexpr double kLearnedBar = 0.02;    // a pattern learned from the residual, in the whole spectrum
inline constexpr double kFullBandBar = 0.005;  // a known one
inline constexpr double kGlobalBar = 0.0001;   // constants of the record
inline constexpr double kLineBar = 0.003;      // spectral lines

// Smallest share of the squares above the noise that an effect must explain, so that nothing is named for a small part
// of an excess that it does not account for (a video codec's slow errors): a named effect, one learned from the
// residual.
inline constexpr double kNamedOfExcess = 0.01, kLearnedOfExcess = 0.1;

// Of an amplitude in some rungs only: in proportion to its degrees of freedom, at least that of a constant.
[[nodiscard]] inline double material_of(RungSet band, const FitView& fit, double in_all) {
  const double share = band == kAllRungs ? 1.0 : fit.held_out.share_of(band);
  return share * in_all > kGlobalBar ? share * in_all : kGlobalBar;
}

}  // namespace core::closure
