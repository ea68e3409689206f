#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "core/identification/correlation.h"
#include "core/identification/folding.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Evidence for a spectral line that is not a mode of the structure: a vibration of the camera, or a steady force.
struct SpectralLineEvidence {
  // Largest MAC of the observed shape with that of a shaking camera: at frequencies beyond the search range, where no
  // mode is expected, a translation and a rotation about the view (a constant and a slope along the rows) with
  // independent phases, its delays undone. 0: these delays do not distinguish such frequencies from the others.
  double camera_mac = 0.0;
  double camera_hz = 0.0;  // the frequency at which it is that large
  // Damping ratio by which the correlation decays from a tenth to half of a segment, where modes have decayed and a
  // steady force continues. Empty: damped too much, too slow for this record, or no correlation at those lags.
  std::optional<double> late_damping_ratio;
  // Share of the correlation left by then, 0..1, and scatter: for a decayed mode, that of its estimate.
  double late_share = 0.0;
  double witness_share = 0.0;  // of the shape's square that goes with what rests (camera_leakage.h)
  bool witness_moves = false;  // ... which does not rest at this frequency
};

// Of one spectrum; keeps references to its arguments. One thread.
class SpectralLineTest {
 public:
  SpectralLineTest(const CpsdSums& sums, const FoldingConfig& folding) : sums_(sums), folding_(folding) {}

  [[nodiscard]] SpectralLineEvidence examine(const UnfoldedPole& pole);

 private:
  void find_camera(const std::vector<std::complex<double>>& observed, double apparent_hz, SpectralLineEvidence& out) const;
  void find_decay(const std::vector<std::complex<double>>& observed, const UnfoldedPole& pole, SpectralLineEvidence& out);
  [[nodiscard]] double envelope(const std::vector<std::complex<double>>& observed, double apparent_hz, int first_lag,
                                int n_lags) const;

  const CpsdSums& sums_;
  const FoldingConfig& folding_;
  std::optional<CorrelationStatus> status_;  // empty: the long correlations are not made yet
  Correlations correlations_;
};

}  // namespace core
