#pragma once

#include <cstddef>
#include <vector>

#include "core/tracking/klt/klt_tracker.h"
#include "core/tracking/region_search.h"
#include "core/types/gray_view.h"
#include "core/types/vector2.h"

namespace core {

// A corner of the first image and its track, frame by frame, relative to that image.
struct SurveyedPoint {
  Vector2 at;                   // position in the first image
  double sigma_px = 0.0;        // of one position per axis, mean over the frames
  std::vector<Vector2> motion;  // one per frame, the first (0, 0)
};

struct RegionSurveyConfig {
  int tile_px = 48;          // corners are selected per tile, so that faint texture is represented
  int points_per_tile = 10;  // strongest first
  double min_distance_px = 8.0;
  double corner_quality = 0.05;
  double most_missing = 0.25;  // largest share of frames in which a point may be unseen; its motion is interpolated
  int patch_px = 96;           // points in such a square that are lost together are searched for together
  double search_px = 200.0;    // search radius
  KltConfig klt{};
};

// Tracks every good corner of a clip, without declared regions.
class RegionSurvey {
 public:
  // Throws std::invalid_argument for an empty image.
  RegionSurvey(const GrayView& first, const RegionSurveyConfig& config);

  // Adds the next frame: each point is searched at its last place and at the place predicted from its motion. A patch
  // that has lost half of its points is searched for as a whole; points still missing are searched where their
  // neighbours have moved.
  void add(const GrayView& frame);

  [[nodiscard]] std::size_t n_frames() const noexcept { return n_frames_; }
  [[nodiscard]] std::size_t n_corners() const noexcept { return points_.size(); }
  // Returns the points tracked to the end and leaves the survey empty.
  [[nodiscard]] std::vector<SurveyedPoint> take_points();

 private:
  RegionSurveyConfig config_;
  KltTracker tracker_;
  std::vector<SurveyedPoint> points_;
  struct Patch {
    std::vector<std::size_t> members;
    RegionSearch search;
    Vector2 motion;  // at the last detection
  };

  void make_patches(const GrayView& first);
  [[nodiscard]] bool is_seen(std::size_t i) const noexcept { return seen_[i].back() + 1 == n_frames_; }
  // True if the point is found at this motion since the first frame; its motion is then updated.
  bool find_at(const GrayView& frame, std::size_t i, const Vector2& motion);
  void search_patches(const GrayView& frame);
  void follow_neighbours(const GrayView& frame);

  std::vector<Patch> patches_;
  std::vector<std::size_t> patch_of_;           // of each point
  std::vector<std::vector<std::size_t>> seen_;  // per point: the frames in which it was found, ascending
  std::size_t n_frames_ = 1;
};

}  // namespace core
