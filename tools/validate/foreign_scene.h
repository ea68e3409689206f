#pragma once

#include <cstdint>
#include <string>

#include "core/closure/observation/observation_record.h"
#include "core/simulation/scene.h"

namespace tools {

// A record without any undeclared effect that is nevertheless not the one for which the model of core/closure was
// written. On top of draw_scene():
//   hover      tails f^-3 ... f^-5 that do not end, corner 0.05 ... 0.5 Hz, 4 ... 25 mm rms, each axis with its own;
//              or, in one of four where the recorded flight is given, that flight
//   structure  on a shaking table or in the wind; in one of four the upper modes lie above half the frame rate
//   camera     readout 0 ... 1 frame; in three of four a background is seen
//   noise      unequal over the points by a factor that is drawn, stated as one number, wrong by a factor
struct ForeignScene {
  core::simulation::Scene scene;
  bool background = true;
  double flight_scale = 0.0;  // of the recorded flight, where it moves the camera
  double stated_px = 0.0;     // sigma that the record states for each of its points
  std::string hover, shaken;  // "recorded" or "tails"; "table" or "wind"
  int n_folded = 0;           // modes above half the rate
  std::string words;          // one line: what was drawn
};
// flight: file of the recorded flight; empty = none.
[[nodiscard]] ForeignScene draw_foreign_scene(std::uint64_t seed, double duration_s, const std::string& flight);

// Its tracks as those of `scene`, which may have an effect more, declared as it is without.
[[nodiscard]] core::closure::ObservationRecord foreign_record(const core::simulation::Scene& scene,
                                                              const ForeignScene& declared);

}  // namespace tools
