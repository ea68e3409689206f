#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/camera_model.h"

namespace core {

// A known length in the structure's plane, between two pixels.
struct KnownLength {
  Vector2 from_px, to_px;  // ideal (undistorted)
  double length_mm = 0.0;
};

struct LengthScale {
  double mm_per_px = 0.0;
  double sigma = 0.0;        // of it, mm/px; grows with the disagreement where that is larger than the pixels' error
  double chi_square = 0.0;   // of the lengths about the one scale, in the stated sigma_px; n - 1 degrees of freedom
  std::size_t worst = 0;     // the length that disagrees most
  double worst_share = 0.0;  // its own scale over the common one, minus 1
};

// One scale S from several lengths L_i seen as d_i px: least squares of d_i - L_i / S, all ends equally accurate
// (sigma_px per axis), so long lengths weigh more. Lengths and distances must be positive; none gives mm_per_px 0.
[[nodiscard]] LengthScale fit_length_scale(std::span<const KnownLength> lengths, double sigma_px) noexcept;

// A region, as far as its scale is concerned.
struct ScaledPlace {
  Vector2 centre_px;            // ideal
  Vector2 direction{1.0, 0.0};  // unit, in the image: that of its displacement
};

// Obliqueness of the plane that the known lengths do not exclude.
struct ObliquenessBound {
  double least_deg = 0.0, largest_deg = 0.0;  // of the angles to the image plane that the lengths do not exclude
  struct Range {
    double low = 1.0, high = 1.0;  // true scale over the common scale, at this place
  };
  std::vector<Range> places;
  double between = 1.0;  // largest ratio of two places' scales under one plane: the effect on a mode shape
};

// Tries planes up to `up_to_deg` off the image plane, leaning to all sides: each is placed at the distance that fits
// the lengths best, and is excluded if it misses them by 6.0 more in chi square than the best (95 % for two angles).
// One length excludes nothing. The common scale is that of fit_length_scale. Needs fx, fy, cx, cy; without a
// calibration or a length the result is empty (places is).
[[nodiscard]] ObliquenessBound unexcluded_obliqueness(std::span<const KnownLength> lengths,
                                                      std::span<const ScaledPlace> places, const CameraModel& camera,
                                                      double sigma_px, double up_to_deg);

}  // namespace core
