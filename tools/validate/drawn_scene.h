#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/simulation/random_stream.h"
#include "core/simulation/scene.h"

namespace tools {

// A camera in front of a structure, both drawn from a seed, and the tracker's noise: quantities on which no estimate
// may depend.
//   camera     focal length 1300 ... 2800 px at 1920 x 1080, distance 1.5 ... 3 m, 24 ... 60 frames/s, readout 8 ... 30
//   ms
//              of at most 0.95 of a frame
//   structure  shear frame of 4 ... 8 storeys, first mode 1 ... 2 Hz, masses and stiffnesses that differ by storey,
//   damping
//              0.5 ... 2 % by mode; it fills 0.75 ... 0.95 of the height that the drift leaves, and its roof moves by
//              2.5 ... 5 px rms on a shaken ground
//   noise      0.01 ... 0.1 px rms, unequal over the points, stated per point with an error
struct DrawnScene {
  core::simulation::Scene scene;
  std::string words;  // one line: what was drawn
};
[[nodiscard]] DrawnScene draw_scene(std::uint64_t seed, double duration_s);

// Random numbers of one subject of a seed; a further draw of one subject changes no other subject.
class Draw {
 public:
  Draw(std::uint64_t seed, std::string_view subject);
  [[nodiscard]] double uniform(double low, double high) noexcept { return low + (high - low) * stream_.uniform(); }
  [[nodiscard]] double log_uniform(double low, double high) noexcept;
  [[nodiscard]] int whole(int low, int high) noexcept;  // both included
  [[nodiscard]] double sign() noexcept { return stream_.uniform() < 0.5 ? -1.0 : 1.0; }
  [[nodiscard]] double gaussian() noexcept { return stream_.gaussian(); }

 private:
  core::simulation::RandomStream stream_;
};

}  // namespace tools
