#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/tracking/motion_groups.h"
#include "core/tracking/point_seeder.h"
#include "core/types/region.h"

namespace core {

struct RegionProposalConfig {
  MotionGroupConfig groups{};
  std::size_t min_points = 6;  // of a region
  double min_side_px = 14.0;
  double longest_share = 0.3;  // of the image's longer side: longer regions are divided
  double least_motion = 3.0;   // rms, in multiples of the region's own noise: with less it is static
  std::size_t max_regions = 12;
};

struct ProposedRegion {
  Region region;
  std::size_t n_points = 0;
  double motion_px = 0.0;  // rms of the fast motion, without the camera's where a static group was found
  double noise_px = 0.0;   // expected, of one displacement of the region along its axis
  double shared = 0.0;     // share of its motion that a few motions common to all parts explain, 0 ... 1
};

struct RegionProposal {
  std::vector<ProposedRegion> regions;  // what moves like a structure first: see propose_regions
  std::optional<ProposedRegion> rest;   // of role background: shows the camera's own motion
  std::size_t n_points = 0;             // examined
  double lowest_moving_v_px = 0.0;      // of all points that move in groups, in a region or not
  std::string remark;                   // what was not found, and why that may be; or empty
};

// Rectangles that do not overlap, each on points that move together and differently from the static ones. A structure's
// parts move in a few common ways (its modes), grass and people in their own: first come parts that share their motion,
// far above their noise, and of several that move alike one before the others. Named part1,
// part2, ... from the bottom up if they stand one above the other, else from the left, and `rest` (static). Pure: the
// same points give the same rectangles. Few frames (less than two seconds) are not conclusive.
[[nodiscard]] RegionProposal propose_regions(const std::vector<SurveyedPoint>& points, double rate_hz, int width_px,
                                             int height_px, const RegionProposalConfig& config);

// Whether the regions stand one above the other, as the floors of a building do.
[[nodiscard]] bool is_upright(const std::vector<ProposedRegion>& regions);

}  // namespace core
