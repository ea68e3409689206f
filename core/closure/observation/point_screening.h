#pragma once

#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"

namespace core::closure {

// Points that do not move with their region: what the tracker lost and did not say. Each point is compared with the
// affine motion of the other points of its region (quadratic where the region is large), frame by frame, whatever that
// motion is: all fields that are smooth over a region (turns, lens, readout, zoom) pass. Scatter is a median over the
// record, studentised, in sigmas of the point and in units of the region's median; the worst point is judged by the
// others alone, then the next (backward elimination). Redescending weights in three steps: a scatter of up to kDoubtful
// counts in full; up to kBad the point's sigma is raised to it; above, the point becomes missing. Single positions
// beyond kFar of their point's scatter become missing. Regions of fewer than kLeastPoints points are left as they are.
//
// Changes record.sigma_px, u_px, v_px. Returns what was found in words; nothing of sound records.
inline constexpr double kDoubtful = 3.0, kBad = 5.0, kFar = 8.0;
inline constexpr std::size_t kLeastPointsToScreen = 6;
[[nodiscard]] std::vector<std::string> screen_points(ObservationRecord& record);

}  // namespace core::closure
