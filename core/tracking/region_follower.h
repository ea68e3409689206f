#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/motion_predictor.h"
#include "core/types/region.h"
#include "core/types/track.h"
#include "core/types/vector2.h"

namespace core {

struct RegionFollowerConfig {
  int width_px = 0, height_px = 0;
  int min_points = 3;               // with fewer inliers the region is not measured in this frame
  std::uint32_t lost_after = 50;    // frames without a measurement until a region inside the image counts as lost
  double least_share_inside = 0.5;  // of a region's points inside the image: below, it has left the image
};

// Predicts where the points of every region are in the next frame, and keeps the region's state. A point of a measured
// region is predicted from its position by the region's motion (motion_predictor.h). A region that is not measured is
// predicted from the others: by the similarity (translation, rotation, magnification) from the keyframe to the other
// regions' points, by least squares, plus its own deviation from it when last measured. It can then be found after an
// occlusion, or when the drifting camera sees it again; points and channel keep their reference positions. Fixed
// memory; does not allocate after construction.
class RegionFollower {
 public:
  // keyframe: positions of the points of all regions, in any order; region_of_point: < n_regions.
  RegionFollower(RegionFollowerConfig config, std::vector<Vector2> keyframe, std::vector<std::uint16_t> region_of_point,
                 std::size_t n_regions);

  // Takes the points of a frame after outlier rejection has set `inlier`.
  void update(const TrackFrame& judged) noexcept;

  [[nodiscard]] const Vector2& expected(std::size_t point) const noexcept { return expected_[point]; }
  // Predicted motion of the region since the keyframe, in the next frame.
  [[nodiscard]] Vector2 expected_motion(std::size_t region) const noexcept { return regions_[region].expected; }
  // Motion of the region when last measured.
  [[nodiscard]] Vector2 last_motion(std::size_t region) const noexcept { return regions_[region].offset; }
  [[nodiscard]] RegionState state(std::size_t region) const noexcept { return regions_[region].state; }
  [[nodiscard]] std::uint32_t n_inliers(std::size_t region) const noexcept { return regions_[region].n_inliers; }
  [[nodiscard]] std::uint32_t n_points(std::size_t region) const noexcept { return regions_[region].n_points; }
  [[nodiscard]] std::size_t n_regions() const noexcept { return regions_.size(); }

 private:
  struct Watched {
    RegionState state = RegionState::kMeasuring;
    std::uint32_t n_points = 0, n_inliers = 0, n_inside = 0;
    std::uint32_t n_unmeasured = 0;  // consecutive frames
    Vector2 expected;                // predicted mean motion of its points since the keyframe, in the next frame
    Vector2 offset;                  // mean motion of the inliers since the keyframe
    MotionPredictor prediction;
    Vector2 off_common;  // deviation of the inliers' mean from the common motion, when last measured
  };
  // p = turn k + shift, as complex numbers u + i v.
  struct Similarity {
    double turn_re = 1.0, turn_im = 0.0;
    Vector2 shift;
    [[nodiscard]] Vector2 of(const Vector2& k) const noexcept {
      return {turn_re * k.u - turn_im * k.v + shift.u, turn_im * k.u + turn_re * k.v + shift.v};
    }
  };

  [[nodiscard]] bool is_measured(std::size_t region) const noexcept;
  [[nodiscard]] bool is_used(const TrackPoint& point) const noexcept;
  void measure_regions(const TrackFrame& judged) noexcept;
  void fit_common(const TrackFrame& judged) noexcept;
  void note_distances(const TrackFrame& judged) noexcept;
  void predict(const TrackFrame& judged) noexcept;
  void judge_states() noexcept;

  RegionFollowerConfig config_;
  std::vector<Vector2> keyframe_, expected_;
  std::vector<std::uint16_t> region_of_point_;
  std::vector<Watched> regions_;
  Similarity common_;
};

}  // namespace core
