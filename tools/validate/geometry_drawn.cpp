#include "tools/validate/geometry_drawn.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/simulation/presets.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/identification_scene.h"

namespace tools {
namespace {

using core::simulation::Scene;

void take_noise(Scene& scene, const Scene& drawn) {
  scene.tracks.noise_px = drawn.tracks.noise_px;
  scene.tracks.noise_spread = drawn.tracks.noise_spread;
  scene.tracks.sigma_error = drawn.tracks.sigma_error;
}

// The figure's structure and view; nearer with a shorter lens, or farther with a longer one.
Scene drawn_camera(Scene scene, const Scene& drawn) {
  Draw draw(scene.seed, "flight");
  const double factor = draw.log_uniform(0.7, 1.4);
  for (auto& plate : scene.plates) plate.z_mm *= factor;
  scene.background.depth_mm *= factor;
  scene.camera.alpha_px *= factor;
  scene.camera.rate_hz = drawn.camera.rate_hz;
  scene.camera.readout_s = drawn.camera.readout_s;
  scene.structure.damping *= draw.log_uniform(0.6, 1.6);
  take_noise(scene, drawn);
  return scene;
}

void look_up(Scene& scene, double elevation_deg) {
  const double distance_mm = scene.plates.front().z_mm, angle = elevation_deg * std::numbers::pi / 180.0;
  scene.camera.pitch_rad = angle;
  scene.camera.y_mm = distance_mm * std::sin(angle);
  scene.camera.z_mm = distance_mm * (1.0 - std::cos(angle));
}

}  // namespace

Scene drawn_flight(const Scene& fixed, const DrawnFlight& limits) {
  Scene drawn = draw_scene(fixed.seed, fixed.duration_s).scene;
  if (!limits.with_structure) return drawn_camera(fixed, drawn);
  drawn.hover = fixed.hover;
  if (fixed.excitation.rms_mm == 0.0) drawn.excitation.rms_mm = 0.0;
  drawn.camera.alpha_px *= limits.focal_share;
  if (limits.elevation_deg != 0.0) look_up(drawn, limits.elevation_deg);
  for (auto& plate : drawn.plates) plate.texture.pitch_mm = 0.0;
  drawn.background.texture.pitch_mm = 0.0;
  settle_textures(drawn);
  return drawn;
}

std::vector<std::string> drawn_configuration(const Scene& scene, const DrawnFlight& limits) {
  const double samples = limits.segment_s * scene.camera.rate_hz;
  std::vector<std::string> out{
      fmt::format("spectrum.segment={:.0f}", std::exp2(std::round(std::log2(samples)))),
  };
  if (limits.looks_for_folds) {
    out.push_back(fmt::format("identification.max_frequency_hz={:.3f}", fold_limit_hz(scene.camera.rate_hz)));
  }
  return out;
}

}  // namespace tools
