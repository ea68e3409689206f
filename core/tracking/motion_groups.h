#pragma once

#include <cstddef>
#include <vector>

#include "core/tracking/region_survey.h"

namespace core {

struct MotionGroupConfig {
  double slow_s = 1.0;           // slower than this counts as the camera's hover
  double neighbour_px = 30.0;    // points farther apart are not compared
  double same_noise = 2.5;       // two points move together: they differ by less than this many of their sigmas,
  double same_share = 0.15;      // or by less than this share of their motion relative to the static points
  double moves_by = 3.0;         // a point moves: multiple of its sigma, with what the static points move beyond theirs
  double least_sigma_px = 0.02;  // lower bound of a point's sigma: the tracker's own excludes the surroundings
};

// Neighbouring points that move together.
struct MotionGroup {
  std::vector<std::size_t> members;  // of the points given
  bool is_at_rest = false;           // the one that shows the camera's own motion
};

struct MotionGroups {
  std::vector<MotionGroup> groups;  // the largest first, the static one last; single points in none
  // Per point, motion about the slow motion, minus the camera's where a static group was found.
  std::vector<std::vector<Vector2>> fast_motion;
  bool has_rest = false;
};

// Motion slower than slow_s is removed first (moving mean). The group that covers the largest part of the image is
// static, if that is more than any structure would cover: a similarity per frame, fitted to it, is removed from every
// point. Points that then move are grouped; all others are static. Empty without points. rate_hz: of the frames.
[[nodiscard]] MotionGroups group_by_motion(const std::vector<SurveyedPoint>& points, double rate_hz, int width_px,
                                           int height_px, const MotionGroupConfig& config);

// Root mean square over the frames of both axes together.
[[nodiscard]] double rms_motion(const std::vector<Vector2>& motion);

}  // namespace core
