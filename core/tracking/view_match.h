#pragma once

#include <string>

#include "core/types/track.h"

namespace core {

// Is what the tracker found of a keyframe's points in another image the same view? Of every region at least half its
// points, and min_points, must be seen and move alike to within a pixel, once the similarity (shift, turn,
// magnification) that takes all points there is undone; the magnification must lie within 5 %. Sets `inlier` of the
// points that agree. Empty: it is; else what speaks against it.
[[nodiscard]] std::string why_other_view(const TrackFrame& keyframe, TrackFrame& now, int min_points);

}  // namespace core
