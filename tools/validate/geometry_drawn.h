#pragma once

#include <string>
#include <vector>

#include "core/simulation/scene.h"

namespace tools {

// Parts of a figure's flight that are drawn from the seed, unless the figure fixes them (drawn_scene.h). The hover, the
// excitation and all else remain those of the figure.
struct DrawnFlight {
  bool with_structure = true;  // false: only camera, noise, damping, and the distance in proportion to the focal length
  double focal_share = 1.0;    // of the drawn focal length: a wider lens
  double elevation_deg = 0.0;  // the camera is this far below the middle, at the drawn distance, and aimed at it
  double segment_s = 41.0;     // of the spectra: the nearest power of two of samples is used
  bool looks_for_folds = true;
};
[[nodiscard]] core::simulation::Scene drawn_flight(const core::simulation::Scene& fixed, const DrawnFlight& limits);

// The operator's declarations, "section.key=value".
[[nodiscard]] std::vector<std::string> drawn_configuration(const core::simulation::Scene& scene,
                                                           const DrawnFlight& limits);

}  // namespace tools
