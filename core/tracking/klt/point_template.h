#pragma once

#include <array>
#include <cstdint>

#include "core/tracking/klt/deformation.h"
#include "core/tracking/klt/patch.h"

namespace core {

// Fixed point, fractional bits: of interpolated grey values, and of those compared with the template.
inline constexpr int kGreyBits = 7, kMatchBits = 3;

// Template of a tracked point, prepared so that a step towards it is linear in the raw image (inverse-compositional
// Lucas-Kanade, Baker & Matthews 2004): step(p) = sum_x S(x) I(x + p). I(x + p) is interpolated by quintic splines
// whose prefilter is folded into S once, so the image is never filtered. S is orthogonal to the template and to a
// constant: gain and offset of the light have no effect. H = sum g_smooth g^T combines a gradient with little noise
// (Gaussian derivative, 0.7 px) with the exact one, so that steps have the right length for fine texture too.
struct PointTemplate {
  using Factors = std::array<std::int16_t, std::size_t{kFolded} * kRow>;  // rows of the folded window

  alignas(64) Factors step_u{}, step_v{};
  alignas(64) Factors texture{};  // template smoothed by the spline's weights, about its mean; 0 outside the window
  alignas(64) Factors mask{};     // -1 inside the window
  int radius = kWindowRadius;     // of the compared window
  double px_per_unit = 0.0;       // scale of the integer sums
  double origin_u = 0.0, origin_v = 0.0;              // sums at the template itself, in their units
  double mean = 0.0, variance = 0.0;                  // of the window's grey values
  double texture_mean = 0.0, texture_variance = 0.0;  // of `texture`, grey and grey^2
  double variance_u = 0.0, variance_v = 0.0;          // px^2 for white noise of variance 1 in the image
  DeformationResponse deformed;
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
