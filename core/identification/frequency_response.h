#pragma once

#include <vector>

#include "core/types/cpsd.h"

namespace core {

// A peak of the response to a measured input, H1 = S_rx / S_xx (Bendat & Piersol, Random Data, section 6.1).
struct ResponsePeak {
  double frequency_hz = 0.0;  // interpolated by a parabola through the logarithm of the gain
  double gain = 0.0;          // of the channel with the largest response, output per input
  int channel = 0;            // that channel
  double coherence = 0.0;     // at the peak, 0..1
};

// Local maxima of the largest gain over the other channels, ordered by frequency and below max_frequency_hz. A peak has
// a gain of at least 3 and of twice the lowest gain between it and the next higher maximum on either side, and a
// coherence of at least one half. Empty without data. If channels and input are of one quantity (floor and ground
// accelerations), the gains of a rigid structure are 1.
[[nodiscard]] std::vector<ResponsePeak> response_peaks(const CpsdSums& sums, int input, double max_frequency_hz);

}  // namespace core
