#pragma once

#include <span>
#include <vector>

#include "core/tracking/klt/template_average.h"
#include "core/tracking/point_reseeder.h"
#include "core/tracking/region_deformation.h"
#include "core/tracking/region_follower.h"
#include "core/tracking/region_search.h"
#include "core/types/track.h"

namespace core {

struct PointFinderConfig {
  KltConfig klt;
  int min_points = 3;        // a region with fewer points is not measured
  double search_px = 200.0;  // search radius for a region that is not at its predicted place
  int reseed_after = 250;    // frames until a lost point gets a new template (point_reseeder.h); 0: never
};

// Finds all points of all regions in one image, each first at its predicted position. If the points of a region then
// disagree, or match worse than usual, the prediction of the region was wrong: it is searched for at its last position,
// at the position suggested by the other regions' prediction errors, and, for a few regions per frame, as a whole
// (region_search.h). The place where most points match well is used. Positions are corrected for the deformation of
// each region in the same image (region_deformation.h). Does not allocate after construction.
class PointFinder {
 public:
  // keyframe: positions of the points in that image; the points of a region are consecutive.
  PointFinder(const PointFinderConfig& config, const GrayView& image, const std::vector<Vector2>& keyframe,
              const std::vector<std::uint16_t>& region_of_point, std::size_t n_regions);

  void find(const GrayView& gray, const RegionFollower& expected) noexcept;
  // Takes the same frame after outlier rejection and updates the usual residual of the inliers.
  void learn(const TrackFrame& judged) noexcept;

  [[nodiscard]] std::uint32_t n_reseeded() const noexcept { return reseeder_.n_reseeded(); }
  [[nodiscard]] const std::vector<KltPoint>& points() const noexcept { return found_; }

 private:
  struct Region {
    std::size_t first = 0, n = 0;  // range of the region's points
    RegionSearch search;
  };
  // Match quality of a region's points: larger is better; the first field has priority.
  struct Look {
    int n_convincing = 0, n_agreeing = 0;
    Vector2 motion;  // median over the points
    [[nodiscard]] bool is_better_than(const Look& other) const noexcept {
      return n_convincing != other.n_convincing ? n_convincing > other.n_convincing : n_agreeing > other.n_agreeing;
    }
  };

  void look(const GrayView& gray, const Region& region, const RegionFollower& expected, const Vector2& shift) noexcept;
  [[nodiscard]] Look judge(const Region& region) noexcept;
  [[nodiscard]] bool is_good(const Region& region, const Look& look) const noexcept;
  void look_for_rest(const GrayView& gray, const Region& region, const Look& look) noexcept;
  [[nodiscard]] bool improves(const GrayView& gray, const Region& region, const RegionFollower& expected,
                              const Vector2& shift, Look& best) noexcept;
  void correct_for_deformation() noexcept;
  void leave_out_disturbed(const Region& region) noexcept;
  [[nodiscard]] Vector2 median_motion(const Region& region) noexcept;

  PointFinderConfig config_;
  KltTracker klt_;
  TemplateAverage templates_;
  PointReseeder reseeder_;
  RegionDeformation deformation_;
  std::vector<Vector2> keyframe_;
  std::vector<Region> regions_;
  std::vector<KltPoint> found_, best_;
  std::vector<double> usual_;  // typical residual of each point, px; 0: unknown
  std::vector<double> scratch_u_, scratch_v_;
  std::size_t next_search_ = 0;  // regions are searched in turn
};

}  // namespace core
