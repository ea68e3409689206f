#pragma once

#include <string>

#include "core/closure/observation/residual_view.h"

namespace app {

struct ResidualPair {
  core::closure::ResidualView before, after;
  int width_px = 0, height_px = 0;  // of the image
  double noise_px = 0.0;            // stated, per axis
};

// Leading pattern of the residual over the image, before and after; all arrows on one stated scale.
[[nodiscard]] std::string closure_field_svg(const ResidualPair& residual);
// Spectrum of the residual and rms of its patterns, before and after, with the stated noise.
[[nodiscard]] std::string closure_residual_svg(const ResidualPair& residual);

}  // namespace app
