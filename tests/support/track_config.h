#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/simulation/track_generator.h"
#include "core/types/frame.h"
#include "firmware_app/config/config.h"

namespace tests {

inline core::CameraInfo track_camera(const core::simulation::TrackGenerator& tracks) {
  const auto& camera = tracks.motion().scene().camera;
  core::CameraInfo info;
  info.width_px = camera.width_px, info.height_px = camera.height_px, info.rate_hz = camera.rate_hz;
  info.readout_ns = std::llround(1e9 * camera.readout_s);
  return info;
}

// The scene as its user would declare it, with a radial distortion. more: further YAML; scale: further keys of that
// map.
inline app::AppConfig track_config(const core::simulation::TrackGenerator& tracks, const std::string& more,
                                   double distortion = 0.0, const std::string& scale = "") {
  const auto& camera = tracks.motion().scene().camera;
  std::string text = "camera: {source: a.mp4}\n";
  text += fmt::format("calibration: {{fx: {0}, fy: {0}, cx: {1}, cy: {2}, distortion: [{3}, 0, 0, 0]}}\nregions:\n",
                      camera.alpha_px, camera.cx_px, camera.cy_px, distortion);
  for (const auto& [body, region] : tracks.regions()) {
    const char* role = region.role == core::RegionRole::kBackground ? "background, depth_m: 4"
                       : region.role == core::RegionRole::kBase     ? "base"
                                                                    : "structure";
    text += fmt::format("  - {{name: {}, rect: [{}, {}, {}, {}], role: {}}}\n", region.name, region.u_px, region.v_px,
                        region.width_px, region.height_px, role);
  }
  text += fmt::format("scale: {{known_length_mm: 300, from: [600, 500], to: [{}, 500]{}}}\n",
                      600.0 + 300.0 * camera.alpha_px / tracks.motion().scene().plates[0].z_mm, scale);
  return app::parse_config(text + more, "a.yaml");
}

}  // namespace tests
