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
  double sigma = 0.0;        // of mm_per_px; computed from the disagreement if that exceeds the error of the pixels
  double chi_square = 0.0;   // of the lengths about the common scale, for the stated sigma_px; n - 1 degrees of freedom
  std::size_t worst = 0;     // index of the length that disagrees most
  double worst_share = 0.0;  // its own scale over the common one, minus 1
};

// One scale S from several lengths L_i seen as d_i px: least squares of d_i - L_i / S with equal accuracy of all ends
// (sigma_px per axis), so that long lengths have more weight. Lengths and distances must be positive; without lengths
// mm_per_px is 0.
[[nodiscard]] LengthScale fit_length_scale(std::span<const KnownLength> lengths, double sigma_px) noexcept;

// Position and direction at which a region's scale is needed.
struct ScaledPlace {
  Vector2 centre_px;            // ideal
  Vector2 direction{1.0, 0.0};  // unit vector in the image: direction of its displacement
};

// Range of obliqueness that the known lengths do not exclude.
struct ObliquenessBound {
  double least_deg = 0.0, largest_deg = 0.0;  // range of angles to the image plane that the lengths do not exclude
  struct Range {
    double low = 1.0, high = 1.0;  // true scale over the common scale, at this place
  };
  std::vector<Range> places;
  double between = 1.0;  // largest ratio of two places' scales under one plane: the effect on a mode shape
};

// Tests planes up to `up_to_deg` off the image plane, tilted in all directions. Each is placed at the distance that
// fits the lengths best, and excluded if its chi square exceeds that of the best by 6.0 (95 % for two angles). One
// length excludes nothing. The common scale is that of fit_length_scale. Needs fx, fy, cx, cy; without a calibration or
// a length the result (places) is empty.
[[nodiscard]] ObliquenessBound unexcluded_obliqueness(std::span<const KnownLength> lengths,
                                                      std::span<const ScaledPlace> places, const CameraModel& camera,
                                                      double sigma_px, double up_to_deg);

}  // namespace core
