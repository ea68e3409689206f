#pragma once

#include <vector>

#include "core/types/cpsd.h"
#include "core/types/displacement.h"

namespace core {

// Response of the structure to its measured base motion near a frequency: |S_rb| / S_bb, the largest over the other
// channels. A mode is a local maximum of it; a peak of the base's own spectrum (or of the camera's motion) is not.
struct BaseResponse {
  double gain = 0.0;         // at the frequency; 0 if no base is measured
  double gain_beside = 0.0;  // larger of the gains at one tenth of the frequency above and below
};

[[nodiscard]] BaseResponse base_response(const CpsdSums& sums, const std::vector<ChannelInfo>& channels,
                                         double frequency_hz);

}  // namespace core
