#pragma once

#include <cstddef>
#include <vector>

#include "core/tracking/region_survey.h"

namespace core {

struct MotionGroupConfig {
  double slow_s = 1.0;           // slower than this counts as the camera's hover
  double neighbour_px = 30.0;    // points farther apart are not compared
  double same_noise = 2.5;       // two points move together: they differ by less than so many of their own deviations,
  double same_share = 0.15;      // or by less than this share of what they move by against what rests
  double moves_by = 3.0;         // a point moves: more than so many of its deviations, and of what resting ones do
  double least_sigma_px = 0.02;  // the tracker's own deviations leave out what the patches' surroundings add
};

// Points that lie near one another and move together.
struct MotionGroup {
  std::vector<std::size_t> members;  // of the points given
  bool is_at_rest = false;           // the one that shows the camera's own motion
};

struct MotionGroups {
  std::vector<MotionGroup> groups;  // the largest first, what rests last; single ones in none
  // Per point, about the slow motion and, where something rests, without the camera's: what is left of its motion.
  std::vector<std::vector<Vector2>> fast_motion;
  bool has_rest = false;
};

// Motion is first freed from everything slower than slow_s (a moving mean). The group that covers the largest part of
// the picture rests, if that is more than any structure would: a similarity per frame, fitted to it, is taken out of
// every point. What moves then is grouped; everything else rests. Empty without points. rate_hz: of the frames.
[[nodiscard]] MotionGroups group_by_motion(const std::vector<SurveyedPoint>& points, double rate_hz, int width_px,
                                           int height_px, const MotionGroupConfig& config);

// Root mean square over the frames of both axes together.
[[nodiscard]] double rms_motion(const std::vector<Vector2>& motion);

}  // namespace core
