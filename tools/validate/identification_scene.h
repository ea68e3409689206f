#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/simulation/scene.h"
#include "core/simulation/structure/structure_model.h"

namespace tools {

// The paper's six.
[[nodiscard]] const std::vector<double>& storey_frequencies_hz();

// A storey per frequency with the shapes of the uniform chain, seen at 1 px = 1 mm. Floors lie one
// above the other over `row_span` of the image's rows, the roof on top; the base beside the lowest floor. The view has
// no
// disturbance other than channel noise; exposures are instantaneous.
struct StoreysSetup {
  enum class Shaken : std::uint8_t {
    kBase,        // white acceleration of the ground, and forces that alone move the roof by 5 % of it
    kModalParts,  // independent white force on each mode: kModalParts of the roof's motion
    kNothing      // a rigid building
  };
  Shaken shaken = Shaken::kBase;
  double duration_s = 300.0, rate_hz = 60.0;
  double readout_frames = 0.66, row_span = 0.9;
  double roof_rms_px = 2.0, noise_px = 0.003;
  std::vector<double> frequency_hz = storey_frequencies_hz();
  std::vector<double> damping_ratio{0.01};  // by mode; the last applies to all higher ones
  double noise_spread = 0.0;                // standard deviation of the logarithm of the channels' noise
  // With these frequencies and damping, in place of the chain; not with kModalParts.
  std::optional<core::simulation::StructureModel> structure = {};

  [[nodiscard]] std::size_t n_storeys() const noexcept { return frequency_hz.size(); }
};
[[nodiscard]] core::simulation::Scene storeys_scene(const StoreysSetup& setup, std::uint64_t seed);

// Camera, structure and noise of draw_scene() in place of those of `fixed`, whose excitation and duration stay; with
// keeps_readout, its readout too. The highest mode lies between the given shares of the frame rate: if the drawn one
// does not, or if two modes appear within 0.15 Hz of each other, all frequencies are scaled to a drawn position.
struct DrawnStoreys {
  double least_top = 0.0, most_top = 0.75;
  bool keeps_readout = false;
};
[[nodiscard]] StoreysSetup drawn_storeys(StoreysSetup fixed, std::uint64_t seed, const DrawnStoreys& limits = {});
// Upper limit of the search for alias orders at a rate: 20 Hz at 25 frames/s.
[[nodiscard]] inline double fold_limit_hz(double rate_hz) noexcept { return 0.8 * rate_hz; }

inline constexpr std::size_t kMostStoreys = 8;
inline constexpr std::array<double, kMostStoreys> kModalParts{1.0,  0.2,   0.08,  0.04,
                                                              0.02, 0.012, 0.008, 0.005};  // of the roof

// Height of each mode's peak over the channels' noise, dB, in the channel where it is highest: one-sided density of
// the mode's own response at its frequency, for the density of input whose expected level is that of the scene.
[[nodiscard]] std::vector<double> peaks_over_noise_db(const core::simulation::Scene& scene);

}  // namespace tools
