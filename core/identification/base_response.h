#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Response of the structure to its measured base motion near a pole: transmissibilities H_r = S_rb / S_bb [Bendat &
// Piersol 2010, H1 estimate] of the other channels. A mode is a pole of H_r; a peak of the base's own spectrum, or of
// camera motion, leaves H_r smooth.
struct BaseResponse {
  double gain = 0.0;         // largest |H_r| at the frequency; 0 if no base is measured
  double gain_beside = 0.0;  // larger of the gains at one tenth of the frequency above and below
  double coherence = 0.0;    // of the base and the channel that follows it best, at the frequency
  // Of the channel with the most significant resonance: height of the resonance curve of this pole in H_r, fitted
  // together with a straight line over six half-power widths to either side; its standard deviation; and the motion
  // relative to the base, |H_r - 1|, at the pole with that curve and without it.
  double resonance = 0.0, resonance_sigma = 0.0, relative = 0.0, relative_without = 0.0;
  // The same curve, squared, fitted to the base's own spectrum: height over the spectrum beside it, and sigma.
  double base_peak = 0.0, base_peak_sigma = 0.0;
  // The fit exists, and the base moved for two thirds of the record or more: only then does a smooth spectrum show
  // that the input has no peak. Peaks of a short transient input are lost in the scatter of its few segments.
  bool base_is_known = false;
};

// frequency_hz: apparent, with the pole's damping ratio. First-order cost: bins near the pole times channels.
[[nodiscard]] BaseResponse base_response(const CpsdSums& sums, const std::vector<ChannelInfo>& channels,
                                         double frequency_hz, double damping_ratio = 0.01);

}  // namespace core
