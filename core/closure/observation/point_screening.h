#pragma once

#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"

namespace core::closure {

// Finds points that do not move with their region: undetected tracking failures. Each point is compared with the affine
// motion of the other points of its region (quadratic in large regions), frame by frame, so any field that is smooth
// over a region (rotation, lens, readout, zoom) passes. Scatter is the median over the record, studentised, in sigmas
// of the point and relative to the region's median; the worst point is tested against the others alone, then the next
// (backward elimination). Redescending weights in three steps: up to kDoubtful full weight; up to kBad the point's
// sigma is raised to its scatter; above, the point becomes missing, as do single positions beyond kFar. Regions of
// fewer than kLeastPointsToScreen points are unchanged.
//
// Changes record.sigma_px, u_px, v_px. Returns a description of the findings; empty for sound records.
inline constexpr double kDoubtful = 3.0, kBad = 5.0, kFar = 8.0;
inline constexpr std::size_t kLeastPointsToScreen = 6;
[[nodiscard]] std::vector<std::string> screen_points(ObservationRecord& record);

}  // namespace core::closure
