#pragma once

#include <cstdint>
#include <string>

#include "core/closure/observation/observation_record.h"
#include "core/simulation/scene.h"

namespace tools {

// A record without any undeclared effect that nevertheless differs from the records for which the model of core/closure
// was written. In addition to draw_scene():
//   hover      power-law tails f^-3 ... f^-5 without end, corner 0.05 ... 0.5 Hz, 4 ... 25 mm rms, different per axis;
//              or, in one of four records if a recorded flight is given, that flight
//   structure  on a shaking table or in the wind; in one of four records the upper modes lie above half the frame rate
//   camera     readout 0 ... 1 frame; in three of four records a background is visible
//   noise      unequal over the points by a drawn factor, stated as one number that is wrong by a factor
struct ForeignScene {
  core::simulation::Scene scene;
  bool background = true;
  double flight_scale = 0.0;  // of the recorded flight, if it moves the camera
  double stated_px = 0.0;     // sigma stated for each point of the record
  std::string hover, shaken;  // "recorded" or "tails"; "table" or "wind"
  int n_folded = 0;           // modes above half the rate
  std::string words;          // one line: the drawn values
};
// flight: file of the recorded flight; empty = none.
[[nodiscard]] ForeignScene draw_foreign_scene(std::uint64_t seed, double duration_s, const std::string& flight);

// The hover alone: replaces that of `scene`. True if it is the recorded flight.
bool move_camera(core::simulation::Scene& scene, std::uint64_t seed, const std::string& flight);

// The tracks of `scene`, which may contain a further effect, with the declarations of the scene without it.
[[nodiscard]] core::closure::ObservationRecord foreign_record(const core::simulation::Scene& scene,
                                                              const ForeignScene& declared);

}  // namespace tools
