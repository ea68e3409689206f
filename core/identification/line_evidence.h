#pragma once

#include <complex>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/identification/correlation.h"
#include "core/identification/folding.h"
#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Evidence for a spectral line that is not a mode of the structure: a vibration of the camera, or a steady force.
struct SpectralLineEvidence {
  // Largest MAC of the observed shape, its delays removed, with the shape of a vibrating camera: a translation and a
  // rotation about the optical axis (a constant and a slope along the rows) with independent phases, at frequencies
  // beyond the search range, where no mode is expected. 0: the delays do not distinguish such frequencies from the
  // others.
  double camera_mac = 0.0;
  double camera_hz = 0.0;  // the frequency of that largest MAC
  // Damping ratio by which the correlation decays from a tenth to half of a segment; by then modes have decayed, while
  // a steady force continues. Empty: damped too much, too slow for this record, or no correlation at those lags.
  std::optional<double> late_damping_ratio;
  // Share of the correlation that remains there, 0..1; for a decayed mode it is estimation noise.
  double late_share = 0.0;
  // Of a steady line (steady_lines.h): segments over which its phase advances evenly, and its coherence. 0: a pole.
  std::uint64_t steady_segments = 0;
  double steady_coherence = 0.0;
  double witness_share = 0.0;  // share of the shape's square that follows the static region (camera_leakage.h)
  bool witness_moves = false;  // ... which is not static at this frequency
};

// Tests poles of one spectrum; keeps references to its arguments.
class SpectralLineTest {
 public:
  SpectralLineTest(const CpsdSums& sums, const FoldingConfig& folding) : sums_(sums), folding_(folding) {}

  [[nodiscard]] SpectralLineEvidence examine(const UnfoldedPole& pole);

 private:
  void find_camera(const std::vector<std::complex<double>>& observed, double apparent_hz,
                   SpectralLineEvidence& out) const;
  void find_decay(const std::vector<std::complex<double>>& observed, const UnfoldedPole& pole,
                  SpectralLineEvidence& out);
  [[nodiscard]] double envelope(const std::vector<std::complex<double>>& observed, double apparent_hz, int first_lag,
                                int n_lags) const;

  const CpsdSums& sums_;
  const FoldingConfig& folding_;
  std::optional<CorrelationStatus> status_;  // empty: the long correlations are not computed yet
  Correlations correlations_;
};

}  // namespace core
