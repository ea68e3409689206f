#pragma once

#include <cstddef>
#include <vector>

#include "core/tracking/region_survey.h"

namespace core {

struct MotionGroupConfig {
  double slow_s = 1.0;           // slower motion is attributed to the hover
  double neighbour_px = 30.0;    // points of a part farther apart are not compared
  double rest_reach = 0.0625;    // the same for the static group, whose texture may be sparse: share of the longer side
  double same_noise = 2.5;       // two points move together if they differ by less than this many of their sigmas,
  double same_share = 0.15;      // or by less than this share of their motion relative to the static points
  double moves_by = 3.0;         // a point moves: multiple of its sigma, with what the static points move beyond theirs
  double least_sigma_px = 0.02;  // lower bound of a point's sigma: the tracker's own excludes the surroundings
};

// Neighbouring points that move together.
struct MotionGroup {
  std::vector<std::size_t> members;  // of the points given
  bool is_at_rest = false;           // the static group, which shows the camera's own motion
};

struct MotionGroups {
  std::vector<MotionGroup> groups;  // the largest first, the static one last; single points are in no group
  // Motion per point without slow motion, and without the camera's motion if a static group was found.
  std::vector<std::vector<Vector2>> fast_motion;
  bool has_rest = false;
};

// Motion slower than slow_s is removed first (moving mean). The group that covers the largest part of the image is
// static if it covers more than a structure could: a similarity per frame, fitted to it, is removed from every point.
// Points that then move are grouped; all others are static. Empty without points. rate_hz: frame rate.
[[nodiscard]] MotionGroups group_by_motion(const std::vector<SurveyedPoint>& points, double rate_hz, int width_px,
                                           int height_px, const MotionGroupConfig& config);

// Root mean square over the frames, both axes together.
[[nodiscard]] double rms_motion(const std::vector<Vector2>& motion);

}  // namespace core
