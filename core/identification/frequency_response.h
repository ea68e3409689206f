#pragma once

#include <vector>

#include "core/types/cpsd.h"

namespace core {

// A peak of the response to a measured input, H1 = S_rx / S_xx (Bendat & Piersol, Random Data, section 6.1).
struct ResponsePeak {
  double frequency_hz = 0.0;  // between bins by a parabola through the gain's logarithm
  double gain = 0.0;          // of the channel that answers most, output per input
  int channel = 0;            // that channel
  double coherence = 0.0;     // there, 0..1
};

// Local maxima of the largest gain over the other channels, at least 3 and twice the lowest between them and the next
// higher maximum on either side, with a coherence of one half or more, below max_frequency_hz; by frequency. Empty
// without data. Gains of channels of one quantity (floor accelerations over ground acceleration) are 1 for a rigid
// structure.
[[nodiscard]] std::vector<ResponsePeak> response_peaks(const CpsdSums& sums, int input, double max_frequency_hz);

}  // namespace core
