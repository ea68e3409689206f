#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/types/gray_view.h"
#include "core/types/vector2.h"

namespace core {

// Finds a whole region when its points are no longer near their predictions: its keyframe image, reduced eight
// times (four, if it is small), is compared with the image about the predicted place by normalised correlation,
// then at finer scales about the best place. The whole region is compared, so that one of a row of equal dots is
// not confused with another; of similar places the one nearest to the prediction is used if it is clearly the
// nearest. Estimates a translation, within a px or two. Buffers are allocated in the constructor, not in find().
class RegionSearch {
 public:
  // points: of the region, in the keyframe (8-bit grey). reach_px: search radius about the predicted place.
  RegionSearch(const GrayView& keyframe, const std::vector<Vector2>& points, double reach_px);

  struct Found {
    Vector2 motion;            // since the keyframe
    double correlation = 0.0;  // in the finest images, -1 ... 1
    bool is_clear = false;     // high, and no other place is equally good and about as near
  };
  [[nodiscard]] Found find(const GrayView& gray, const Vector2& expected_motion) noexcept;

 private:
  static constexpr std::array<int, 3> kScales{8, 4, 2};

  // Mean grey values of squares of `scale` px.
  struct Picture {
    int scale = 0, width = 0, height = 0;
    std::vector<float> cells;
  };
  static void reduce(const GrayView& gray, int left, int top, Picture& out) noexcept;
  // A candidate place, as motion in px since the keyframe.
  struct Place {
    int du = 0, dv = 0;
    double correlation = -1.0;
  };
  void correlate(const Picture& pattern, const Picture& area) noexcept;
  void list_peaks(const Place& about) noexcept;
  [[nodiscard]] Place refine(const GrayView& gray, Place place) noexcept;
  [[nodiscard]] Found choose(const Vector2& expected_motion) const noexcept;
  [[nodiscard]] double at(int u, int v) const noexcept { return correlations_[static_cast<std::size_t>(v * n_u_ + u)]; }

  int left_ = 0, top_ = 0;  // corner of the pattern in the keyframe
  std::array<Picture, kScales.size()> patterns_, areas_;
  std::size_t first_ = 0;  // first of the scales in use
  int n_u_ = 0, n_v_ = 0;
  std::vector<double> correlations_;  // at all offsets of the last correlate()
  static constexpr std::size_t kMostPlaces = 8;
  std::array<Place, kMostPlaces> places_;
  std::size_t n_places_ = 0;
};

}  // namespace core
