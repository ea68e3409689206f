#pragma once

#include "core/tracking/klt/phase.h"
#include "core/tracking/klt/window_sums.h"
#include "core/types/vector2.h"

namespace core {

// Likeness of an image's window to a template at the found place: I = gain T + offset.
struct TemplateMatch {
  double residual = 0.0;       // variance per pixel after gain and offset, grey^2
  double residual_unit = 0.0;  // residual variance per unit of squares summed over the window
  double correlation = 0.0;    // over the window
};

// A window of an image compared with a phase of a template.
class PhaseMatch {
 public:
  PhaseMatch(const Phase& phase, const WindowSums& sums, int radius) noexcept;

  // Contrast of the window over that of the template: its gain, wherever the window lies.
  [[nodiscard]] double contrast() const noexcept;
  // Displacement from the phase; gain: of the light, about. True: the place is within the phase's range, and gain() is
  // that of this window. False: place() is a step in its direction.
  [[nodiscard]] bool locate(double gain) noexcept;
  [[nodiscard]] const Vector2& place() const noexcept { return place_; }  // px
  [[nodiscard]] double gain() const noexcept { return gain_; }
  // After locate() returned true.
  [[nodiscard]] TemplateMatch judge() const noexcept;

 private:
  const Phase& phase_;
  double n_pixels_;
  Vector2 step_;            // px for gain 1
  double along_ = 0.0;      // product with the template, grey^2
  double contrast2_ = 0.0;  // squares about the mean, summed
  Vector2 place_;
  double gain_ = 1.0;
};

}  // namespace core
