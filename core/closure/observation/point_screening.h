#pragma once

#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"

namespace core::closure {

// Detects points that do not move with their region: undetected tracking failures. Each point is compared with the
// affine motion of the other points of its region (quadratic in large regions), frame by frame, so any field that is
// smooth over a region (rotation, lens, readout, zoom) passes. The scatter of a point is the median of its studentised
// deviations over the record, in sigmas of the point and relative to the region's median. The worst point is tested
// against the others alone, then the next one (backward elimination). Weights are redescending in three steps: up to
// kDoubtful full weight; up to kBad the point's sigma is raised to its scatter; above kBad the point is marked as
// missing, and so are single positions beyond kFar. Regions of fewer than kLeastPointsToScreen points are unchanged.
//
// Changes record.sigma_px, u_px, v_px. Returns a description of the findings; empty for sound records.
inline constexpr double kDoubtful = 3.0, kBad = 5.0, kFar = 8.0;
inline constexpr std::size_t kLeastPointsToScreen = 6;
[[nodiscard]] std::vector<std::string> screen_points(ObservationRecord& record);

}  // namespace core::closure
