#include "tools/validate/trust_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/validate/drawn_scene.h"
#include "tools/validate/foreign_scene.h"
#include "tools/validate/geometry_sensors.h"

namespace tools {
namespace {

using core::simulation::Scene;

// One or two peaks of the ground's own spectrum, away from the modes.
void colour_ground(Scene& scene, std::uint64_t seed) {
  constexpr double kApart = 0.06;  // relative
  Draw draw(seed, "trust_ground");
  const auto modes = modes_of(scene.structure);
  const int n_peaks = draw.whole(1, 2);
  while (static_cast<int>(scene.excitation.base_peaks.size()) < n_peaks) {
    const double f = draw.log_uniform(2.0, 11.0);
    const double damping = draw.log_uniform(0.005, 0.03), gain = draw.log_uniform(3.0, 20.0);
    const bool is_apart = std::none_of(modes.begin(), modes.end(), [&](const auto& mode) {
      return std::abs(f - mode.frequency_hz) < kApart * mode.frequency_hz;
    });
    if (is_apart) scene.excitation.base_peaks.push_back({f, damping, gain});
  }
}

}  // namespace

const char* word_for(Drive drive) noexcept {
  switch (drive) {
    case Drive::kTable:
      return "table";
    case Drive::kColoured:
      return "coloured";
    case Drive::kWind:
      return "wind";
  }
  return "";
}

const char* word_for(Disturbance disturbance) noexcept {
  switch (disturbance) {
    case Disturbance::kNone:
      return "none";
    case Disturbance::kLosses:
      return "losses";
    case Disturbance::kVibration:
      return "vibration";
  }
  return "";
}

TrustFlight trust_flight(Drive drive, std::uint64_t seed, double duration_s, const GeometryOptions& options) {
  TrustFlight out;
  const double readout_ms = 40.0 * Draw(seed, "trust_readout").uniform(0.4, 1.0);
  out.setup = paper_flight(readout_ms);
  out.setup.flight_scale = 0.0;
  std::erase_if(out.setup.configuration, [](const std::string& text) { return text.starts_with("spectrum.segment"); });
  out.job = flight_job(out.setup, seed, duration_s, options);
  Scene& scene = out.job.file.scene;
  out.hover = move_camera(scene, seed, options.flight) ? "recorded" : "tails";
  if (drive == Drive::kWind) scene.excitation.base = 0.0, scene.excitation.forces = 1.0;
  if (drive == Drive::kColoured) colour_ground(scene, seed);
  core::simulation::validate(scene);
  return out;
}

}  // namespace tools
