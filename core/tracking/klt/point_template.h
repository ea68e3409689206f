#pragma once

#include <array>

#include "core/tracking/klt/deformation.h"
#include "core/tracking/klt/patch.h"
#include "core/tracking/klt/phase.h"

namespace core {

// Template of a tracked point: the patch about it at nine places within a pixel (phase.h), so that raw pixels of an
// image are compared and no image is ever interpolated.
struct PointTemplate {
  std::array<std::array<Phase, kPhasesPerPixel>, kPhasesPerPixel> phases;  // thirds of a pixel down, across
  int radius = kWindowRadius;                                              // of the compared window
  double mean = 0.0, variance = 0.0;                                       // of the window's grey values
  double variance_u = 0.0, variance_v = 0.0;  // of a position, px^2 for white noise of variance 1 in the image
  DeformationEnergy deformed{};
  double noise =
      0.0;  // variance of an image's noise, at most: fine texture counts as noise, up to half of the variance
  int n_averaged = 1;         // number of averaged images
  bool is_trackable = false;  // texture in two directions
};

// Variance of a position per axis caused by the noise of an image, px^2.
[[nodiscard]] inline double place_variance(const PointTemplate& pattern) noexcept {
  return 0.5 * (pattern.variance_u + pattern.variance_v) * pattern.noise;
}

// True if a patch about a point has texture in two directions, so that its position can be determined.
[[nodiscard]] bool has_texture(const Patch& patch, int radius) noexcept;
// `patch`: one image, or the mean of n_averaged. radius: 2 ... kWindowRadius.
void build_template(const Patch& patch, int radius, int n_averaged, PointTemplate& out) noexcept;

}  // namespace core
