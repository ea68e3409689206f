#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/render/renderer.h"
#include "core/simulation/scene.h"
#include "core/simulation/scene_motion.h"

namespace tests {

// The paper's building with plates large enough for 480 x 270 px; hovering camera and rolling shutter as in its scene.
inline core::simulation::Scene small_scene(double duration_s, std::uint64_t seed = 1) {
  core::simulation::Scene scene = core::simulation::make_paper_scene(seed, duration_s);
  scene.excitation.rms_mm = 10.0;
  scene.plates = core::simulation::tower_plates(6, 300.0, 110.0, 125.0, 2000.0);
  core::simulation::set_image_size(scene, 480, 270);
  return scene;
}

// The first n frames of the small scene, rendered once and shared: a camera can then be as fast as memory.
struct SceneClip {
  explicit SceneClip(std::uint64_t n_frames)
      : SceneClip(small_scene(static_cast<double>(n_frames) / core::simulation::CameraParameters{}.rate_hz), n_frames) {
  }
  SceneClip(const core::simulation::Scene& scene, std::uint64_t n_frames) : motion(scene) {
    const core::simulation::Renderer renderer(motion.scene());
    auto scratch = renderer.make_scratch();
    const auto& camera = motion.scene().camera;
    const auto n_pixels = static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px);
    frames.assign(n_frames, std::vector<std::uint8_t>(n_pixels));
    for (std::uint64_t k = 0; k < n_frames; ++k) renderer.render(k, frames[k].data(), scratch);
  }

  core::simulation::SceneMotion motion;
  std::vector<std::vector<std::uint8_t>> frames;
};

inline std::shared_ptr<const SceneClip> scene_clip(std::uint64_t n_frames) {
  static std::shared_ptr<const SceneClip> last;
  if (!last || last->frames.size() != n_frames) last = std::make_shared<const SceneClip>(n_frames);
  return last;
}

// The configuration a user would write for the scene: regions, scale, calibration; no telemetry.
inline std::string scene_config(const core::simulation::SceneMotion& motion) {
  const auto& scene = motion.scene();
  std::string text = fmt::format(
      "camera: {{driver: file, source: scene, readout_ms: {}, exposure_ms: {}}}\n"
      "calibration: {{fx: {}, fy: {}, cx: {}, cy: {}}}\n",
      1e3 * scene.camera.readout_s, 1e3 * scene.camera.exposure_s, scene.camera.alpha_px, scene.camera.alpha_px,
      scene.camera.cx_px, scene.camera.cy_px);
  text += "tracking: {window_px: 13, min_distance_px: 4, points_per_region: 15}\n";
  text += "telemetry: {lcm_url: \"\"}\nregions:\n";
  for (const auto& [body, region] : core::simulation::tracking_regions(motion)) {
    const char* role = body == 0 ? "base" : body == core::simulation::kBackgroundBody ? "background" : "structure";
    text += fmt::format("  - {{name: {}, rect: [{}, {}, {}, {}], role: {}}}\n", region.name, region.u_px, region.v_px,
                        region.width_px, region.height_px, role);
  }
  const auto from = motion.see(scene.n_bodies() - 1, {0.0, 0.0}, 0.0), to = motion.see(0, {0.0, 0.0}, 0.0);
  return text + fmt::format("scale: {{known_length_mm: {}, from: [{:.2f}, {:.2f}], to: [{:.2f}, {:.2f}]}}\n",
                            scene.plates[0].y_mm - scene.plates.back().y_mm, from.u_px, from.v_px, to.u_px, to.v_px);
}

}  // namespace tests
