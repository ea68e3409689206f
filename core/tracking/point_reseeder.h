#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/klt/template_average.h"
#include "core/types/track.h"

namespace core {

// Re-seeds lost points. A point without an inlier sample for long (covered, peeled paint) gets a new
// template near its original position, at the place given by the similarity (translation, rotation,
// magnification) from the keyframe to the region's other points, by least squares. It is then on trial: it
// is not used while the new template is tracked through kTrialFrames frames. If its scatter about its place
// is twice that of the region's other points, the template is discarded and the next place nearby is tried.
// The mean offset over the trial corrects the reference position, so the displacement continues from the
// keyframe with the error of that mean. At most one template per frame. Does not allocate after
// construction.
class PointReseeder {
 public:
  static constexpr int kTrialFrames = 50;
  static constexpr double kFarthest_px = 12.0;  // distance of a new template from its point

  // keyframe: positions of the tracker's points; the points of a region are consecutive. after_frames: frames without
  // the point while its region is measured; 0: never.
  PointReseeder(const KltTracker& tracker, const std::vector<Vector2>& keyframe,
                const std::vector<std::uint16_t>& region_of_point, int after_frames, int min_points);

  // Takes an image in which the tracker has located its points. Points on trial are marked as not seen. Returns the
  // point that received a new template, -1 for none.
  int judge(const GrayView& gray, std::vector<KltPoint>& found, KltTracker& tracker,
            TemplateAverage& templates) noexcept;
  // Takes the same frame after outlier rejection.
  void learn(const TrackFrame& judged) noexcept;

  [[nodiscard]] std::uint32_t n_reseeded() const noexcept { return n_reseeded_; }

 private:
  struct Point {
    Vector2 keyframe;
    double most_variance_px2 = 0.0;  // limit for a new template's position
    std::size_t first = 0, n = 0;    // range of its region's points
    bool is_inlier = true;           // in the last frame
    int n_lost = 0;                  // consecutive frames, its region measured
    int n_places = 0;                // places tried so far
    bool is_on_trial = false;
    int n_found = 0, n_missed = 0;  // frames of the trial
    Vector2 sum;                    // sum of the offsets from its place
    double squares = 0.0, variances = 0.0;
  };

  struct Place {
    Vector2 at;
    double variance_px2 = 0.0;  // deviation of the region's points from the similarity, per axis
  };

  [[nodiscard]] bool place_of(const Point& point, const std::vector<KltPoint>& found, Place& place) const noexcept;
  void go_on(Point& point, std::size_t i, const std::vector<KltPoint>& found, KltTracker& tracker) noexcept;
  [[nodiscard]] int begin_one(const GrayView& gray, const std::vector<KltPoint>& found, KltTracker& tracker,
                              TemplateAverage& templates) noexcept;

  std::vector<Point> points_;
  int after_frames_, min_points_;
  std::size_t next_ = 0;
  std::uint32_t n_reseeded_ = 0;
};

}  // namespace core
