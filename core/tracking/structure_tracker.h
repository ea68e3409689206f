#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/tracking/point_finder.h"
#include "core/tracking/point_seeder.h"
#include "core/tracking/region_follower.h"
#include "core/types/frame.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace core {

struct StructureTrackerConfig {
  SeedConfig seed;
  KltConfig klt;
  std::vector<Region> regions;
  int min_points = 3;             // a region that seeds fewer points is an error; with fewer inliers it is not measured
  std::uint32_t lost_after = 50;  // frames of search until a region counts as lost
  double search_px = 200.0;       // search radius for a region that is not at its predicted place
  int reseed_after = 250;         // frames until a lost point gets a new template (same reference position); 0: never
};

// Points that were no inliers of their region for kLostForGood frames in a row and more, by the cause of the last
// frame.
struct PointLosses {
  std::uint32_t left_image = 0, light = 0;
  std::uint32_t unlike = 0;     // covered, or another surface in the window
  std::uint32_t elsewhere = 0;  // found, but moving otherwise than the region
  [[nodiscard]] std::uint32_t total() const noexcept { return left_image + light + unlike + elsewhere; }
};

// Tracks all points of all regions: seeds them in the first frame (the keyframe), tracks them against it, and predicts
// their positions from the previous frame after outlier rejection (region_follower.h). Nothing allocates in track() and
// learn().
class StructureTracker {
 public:
  explicit StructureTracker(StructureTrackerConfig config) : config_(std::move(config)) {}

  // Returns an empty text, or the region with too little texture and a remedy.
  [[nodiscard]] std::string seed(const Frame& frame);
  // Instead of seed(): takes the keyframe of an earlier run and its points, grouped by region.
  void set_keyframe(const Frame& image, const TrackFrame& keyframe);
  [[nodiscard]] std::size_t n_points() const noexcept { return region_of_point_.size(); }

  // Fills `out.points` (sized n_points() beforehand). False: the tracker itself failed; no point is seen.
  [[nodiscard]] bool track(const Frame& frame, TrackFrame& out) noexcept;
  // Takes the same frame after outlier rejection has set `inlier`: in the next frame, an outlier is searched for at the
  // place given by its region, and a region that is not measured at the place given by the others.
  void learn(const TrackFrame& judged) noexcept;
  // Number of lost points that were re-seeded, after seed().
  [[nodiscard]] std::uint32_t n_reseeded() const noexcept { return finder_->n_reseeded(); }
  [[nodiscard]] const RegionFollower& regions() const noexcept { return *follower_; }
  static constexpr std::uint32_t kLostForGood = 50;  // frames
  [[nodiscard]] PointLosses losses() const noexcept;

 private:
  void begin(const Frame& frame, const std::vector<cv::Point2f>& points);

  StructureTrackerConfig config_;
  std::vector<std::uint16_t> region_of_point_;  // points of a region follow one another
  std::vector<std::uint32_t> n_lost_;           // frames in a row, of each point
  std::unique_ptr<PointFinder> finder_;
  std::unique_ptr<RegionFollower> follower_;
};

}  // namespace core
