#pragma once

#include <string>
#include <vector>

#include "core/simulation/scene.h"

namespace tools {

// What of a figure's flight is drawn from the seed, where the figure itself does not fix it (drawn_scene.h). The hover,
// what shakes the structure and its rest stay the figure's.
struct DrawnFlight {
  bool with_structure = true;  // false: camera, noise, damping, and distance with the focal length alone
  double focal_share = 1.0;    // of the drawn focal length: a wider lens
  double elevation_deg = 0.0;  // the camera stands so far below the middle, at the drawn distance, and looks at it
  double segment_s = 41.0;     // of the spectra: the power of two of samples that is nearest
  bool looks_for_folds = true;
};
[[nodiscard]] core::simulation::Scene drawn_flight(const core::simulation::Scene& fixed, const DrawnFlight& limits);

// What the operator says of it, "section.key=value".
[[nodiscard]] std::vector<std::string> drawn_configuration(const core::simulation::Scene& scene,
                                                           const DrawnFlight& limits);

}  // namespace tools
