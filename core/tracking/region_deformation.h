#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/tracking/klt/klt_tracker.h"
#include "core/types/track.h"

namespace core {

// Estimates the affine deformation of each region relative to the keyframe, in every image: magnification, roll,
// perspective and rolling-shutter shear, by weighted least squares over the region's points about their mean. The
// deformation common to all regions (caused by the camera) is the prior mean of each, so that the estimate stays stable
// with few or collinear points. Points that were not inliers in the previous image, or are far from the fit, are
// excluded. Does not allocate after construction.
class RegionDeformation {
 public:
  // The points of a region are consecutive.
  RegionDeformation(const std::vector<Vector2>& keyframe, const std::vector<std::uint16_t>& region_of_point,
                    std::size_t n_regions);

  // Takes all points as found in an image.
  void update(const std::vector<KltPoint>& found) noexcept;
  // Takes the same image after outlier rejection.
  void learn(const TrackFrame& judged) noexcept;

  [[nodiscard]] const Deformation& of(std::size_t region) const noexcept { return regions_[region].now; }

 private:
  // Weighted sums about the means over a region's points: x x^T and p x^T, x in the keyframe, p the motion since then.
  struct Moments {
    double uu = 0.0, uv = 0.0, vv = 0.0;
    Deformation motion;
    Vector2 mean_x, mean_p;
    double weight = 0.0;
    [[nodiscard]] Deformation fit(const Deformation& prior, double precision) const noexcept;
  };
  struct Region {
    std::size_t first = 0, n = 0;
    Moments moments;
    Deformation now;
  };

  [[nodiscard]] Moments moments_of(const Region& region, const std::vector<KltPoint>& found) const noexcept;
  [[nodiscard]] Deformation common() const noexcept;
  // Excludes points far from the fit. True: at least one.
  bool leave_out_far(const Region& region, const std::vector<KltPoint>& found) noexcept;
  [[nodiscard]] Vector2 motion(std::size_t i, const std::vector<KltPoint>& found) const noexcept {
    return {found[i].position.u - keyframe_[i].u, found[i].position.v - keyframe_[i].v};
  }

  std::vector<Vector2> keyframe_;
  std::vector<Region> regions_;
  std::vector<std::uint8_t> is_inlier_, is_used_;
  std::vector<double> off_, sorted_;
};

}  // namespace core
