#pragma once

#include <string>

#include "core/types/track.h"

namespace core {

// Tests whether the points of a keyframe, as found in another image, show the same view. Of every region at least half
// of the points, and at least min_points, must be seen and agree within a pixel once the similarity (translation,
// rotation, magnification) common to all points is removed; the magnification must be within 5 %. Sets `inlier` of the
// points that agree. Empty: same view; else the reason why not.
[[nodiscard]] std::string why_other_view(const TrackFrame& keyframe, TrackFrame& now, int min_points);

}  // namespace core
