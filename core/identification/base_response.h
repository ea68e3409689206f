#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Does the structure respond to its measured base near a frequency? |S_rb| / S_bb, the largest over the other channels:
// a mode is a local maximum of it, a peak of the base's own spectrum (or of the camera's motion) is not.
struct BaseResponse {
  double gain = 0.0;         // at the frequency; 0 where no base is measured
  double gain_beside = 0.0;  // the larger of the two sides, one tenth of the frequency away
};

[[nodiscard]] BaseResponse base_response(const CpsdSums& sums, const std::vector<ChannelInfo>& channels,
                                         double frequency_hz);

}  // namespace core
