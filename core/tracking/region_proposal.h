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
  std::size_t min_points = 6;  // points per region
  double min_side_px = 14.0;
  double longest_share = 0.3;  // relative to the image's longer side: longer regions are divided
  double least_motion = 3.0;   // rms in multiples of the region's own noise: below, the region is static
  std::size_t max_regions = 12;
};

struct ProposedRegion {
  Region region;
  std::size_t n_points = 0;
  double motion_px = 0.0;  // rms of the fast motion, without camera motion if a static group was found
  double noise_px = 0.0;   // expected noise of one displacement of the region along its axis
  double shared = 0.0;     // share of its motion explained by a few motions common to all parts, 0 ... 1
};

struct RegionProposal {
  std::vector<ProposedRegion> regions;  // the most structure-like motion first: see propose_regions
  std::optional<ProposedRegion> rest;   // role background: shows the camera's own motion
  std::size_t n_points = 0;             // points examined
  double lowest_moving_v_px = 0.0;      // of all points that move in groups, inside a region or not
  std::string remark;                   // what was not found, with a possible reason; or empty
};

// Proposes rectangles that do not overlap, each on points that move together and differently from the static ones. A
// structure's parts share a few motions (its modes); grass and people do not. Parts that share their motion and move
// far above their noise come first; of several that move alike, one precedes the others. Names: part1, part2, ... from
// the bottom up if the regions stand one above the other, else from the left; `rest` is static. Pure: equal points give
// equal rectangles. Less than two seconds of frames is not conclusive.
[[nodiscard]] RegionProposal propose_regions(const std::vector<SurveyedPoint>& points, double rate_hz, int width_px,
                                             int height_px, const RegionProposalConfig& config);

// True if the regions stand one above the other, like the floors of a building.
[[nodiscard]] bool is_upright(const std::vector<ProposedRegion>& regions);

}  // namespace core
