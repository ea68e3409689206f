#pragma once

#include <array>
#include <cstdint>

#include "core/tracking/klt/point_template.h"
#include "core/types/vector2.h"

namespace core {

// Match of an image with a template: I = gain T + offset, by least squares.
struct TemplateMatch {
  double gain = 0.0;
  double residual = 0.0;       // variance per pixel of the raw image if the residual is white noise, grey^2
  double residual_unit = 0.0;  // residual variance per unit of squares summed over the interpolated window
  double correlation = 0.0;    // over the window, both images smoothed by the spline
};

// The image at a sub-pixel position, for comparison with a template: raw pixels are interpolated with spline weights
// only, because the prefilter is in the template. 16-bit integers throughout, grey values in 128ths: bit-identical on
// every machine. Reused from point to point; does not allocate.
class InterpolatedWindow {
 public:
  void begin(const GrayView& gray, const PointTemplate& point) noexcept;
  // Places the template's centre at (cell + fraction), fraction 0 ... 1.
  void move_to(int cell_u, int cell_v, double fraction_u, double fraction_v) noexcept;
  // px, from the template towards the position, for gain 1: to be subtracted from the position.
  [[nodiscard]] Vector2 step() const noexcept;
  // rest: the remaining step from here; the part of the image that it explains is not counted as residual.
  [[nodiscard]] TemplateMatch match(const Vector2& rest = {}) const noexcept;

 private:
  void load(int cell_u, int cell_v) noexcept;

  GrayView gray_;
  const PointTemplate* point_ = nullptr;
  int cell_u_ = 0, cell_v_ = 0;
  bool is_loaded_ = false;
  double passed_noise_ = 1.0;  // variance of white noise after the interpolation
  alignas(64) std::array<std::int16_t, std::size_t{kImageRows} * kImageColumns> pixels_{};
  alignas(64) PointTemplate::Factors window_{};
};

}  // namespace core
