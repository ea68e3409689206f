#pragma once

#include <cstdint>
#include <vector>

#include "core/tracking/klt/template_average.h"
#include "core/types/track.h"

namespace core {

// Re-seeds lost points. A point without an inlier sample for long (covered, peeled paint) gets a new
// template near its original position, where the similarity (translation, rotation, magnification) from
// the keyframe to the region's other points places it, by least squares. Then it is on trial: it does not
// count while the new template is tracked through kTrialFrames frames; one whose scatter about its place
// is twice that of the region's other points is discarded, and the next place nearby is tried. The mean
// offset over the trial corrects the reference position, so the displacement continues from the keyframe
// with the error of that mean. At most one template per frame. Nothing allocates after construction. One
// thread.
class PointReseeder {
 public:
  static constexpr int kTrialFrames = 50;
  static constexpr double kFarthest_px = 12.0;  // of a new template from its point

  // keyframe: of the tracker's points; the points of a region are consecutive. after_frames: frames without the point
  // while its region is measured; 0: never.
  PointReseeder(const KltTracker& tracker, const std::vector<Vector2>& keyframe,
                const std::vector<std::uint16_t>& region_of_point, int after_frames, int min_points);

  // An image in which the tracker has located its points. Points on trial are not seen afterwards. Returns the point
  // with a new template, -1 for none.
  int judge(const GrayView& gray, std::vector<KltPoint>& found, KltTracker& tracker,
            TemplateAverage& templates) noexcept;
  // The same frame after outlier rejection.
  void learn(const TrackFrame& judged) noexcept;

  [[nodiscard]] std::uint32_t n_reseeded() const noexcept { return n_reseeded_; }

 private:
  struct Point {
    Vector2 keyframe;
    double most_variance_px2 = 0.0;  // of a new template's place
    std::size_t first = 0, n = 0;    // of its region's points
    bool is_inlier = true;           // in the last frame
    int n_lost = 0;                  // frames in a row, its region measured
    int n_places = 0;                // tried
    bool is_on_trial = false;
    int n_found = 0, n_missed = 0;  // of a trial
    Vector2 sum;                    // of the distances from its place
    double squares = 0.0, variances = 0.0;
  };

  struct Place {
    Vector2 at;
    double variance_px2 = 0.0;  // of the region's points about theirs, per axis
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
