#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/simulation/scene.h"

namespace tools {

// Six storeys with the paper's frequencies and the shapes of the uniform chain, seen from where 1 px is 1 mm. Floors
// stand one above the other over `row_span` of the image's rows, the roof on top; the base beside the lowest floor.
// Nothing but channel noise disturbs the view, exposures are instants.
struct StoreysSetup {
  enum class Shaken : std::uint8_t {
    kBase,        // white acceleration of the ground, and forces that alone move the roof by 5 % of it
    kModalParts,  // independent white force on each mode: parts 1 : .2 : .08 : .04 : .02 : .012 of the roof's motion
    kNothing      // a rigid building
  };
  Shaken shaken = Shaken::kBase;
  double duration_s = 300.0, rate_hz = 60.0;
  double readout_frames = 0.66, row_span = 0.9;
  double roof_rms_px = 2.0, noise_px = 0.003;
  double damping_ratio = 0.01;
};
[[nodiscard]] core::simulation::Scene storeys_scene(const StoreysSetup& setup, std::uint64_t seed);

inline constexpr int kStoreys = 6;
inline constexpr std::array<double, kStoreys> kModalParts{1.0, 0.2, 0.08, 0.04, 0.02, 0.012};  // of the roof
[[nodiscard]] const std::vector<double>& storey_frequencies_hz();

// Height of each mode's peak over the channels' noise, dB, in the channel where it stands highest: one-sided density of
// the mode's own response at its frequency, for the density of input whose expected level is that of the scene.
[[nodiscard]] std::vector<double> peaks_over_noise_db(const core::simulation::Scene& scene);

}  // namespace tools
