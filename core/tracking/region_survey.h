#pragma once

#include <cstddef>
#include <vector>

#include "core/tracking/klt/klt_tracker.h"
#include "core/types/gray_view.h"
#include "core/types/vector2.h"

namespace core {

// A corner of the first image and its track, frame by frame, relative to that image.
struct SurveyedPoint {
  Vector2 at;                   // in the first image
  double sigma_px = 0.0;        // of one position, per axis; mean over the frames
  std::vector<Vector2> motion;  // one per frame, the first (0, 0)
};

struct RegionSurveyConfig {
  int tile_px = 48;          // corners are selected tile by tile, so that faint texture is represented
  int points_per_tile = 10;  // strongest first
  double min_distance_px = 8.0;
  double corner_quality = 0.05;
  double most_missing = 0.1;  // share of the frames in which a point may be unseen; it is then where it was seen last
  KltConfig klt{};
};

// Tracks every good corner of a clip, without any regions. One thread.
class RegionSurvey {
 public:
  // Throws std::invalid_argument for an empty image.
  RegionSurvey(const GrayView& first, const RegionSurveyConfig& config);

  // The next frame: each point is searched at its last place, so it may move by klt.reach_px from frame to frame.
  void add(const GrayView& frame);

  [[nodiscard]] std::size_t n_frames() const noexcept { return n_frames_; }
  [[nodiscard]] std::size_t n_corners() const noexcept { return points_.size(); }
  // Points tracked to the end. Leaves the survey empty.
  [[nodiscard]] std::vector<SurveyedPoint> take_points();

 private:
  RegionSurveyConfig config_;
  KltTracker tracker_;
  std::vector<SurveyedPoint> points_;
  std::vector<std::size_t> n_missing_;
  std::size_t n_frames_ = 1;
};

}  // namespace core
