#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/simulation/presets.h"
#include "core/simulation/render/renderer.h"

namespace test_support {

// Light of one frame, without noise.
struct Image {
  int width_px, height_px;
  std::vector<float> light;

  Image(const core::simulation::Renderer& renderer, std::uint64_t frame)
      : width_px(renderer.scene().camera.width_px),
        height_px(renderer.scene().camera.height_px),
        light(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px)) {
    renderer.render_light(frame, light.data());
  }

  [[nodiscard]] double pixel(int u, int v) const {
    return static_cast<double>(
        light[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(u)]);
  }

  // Twelve-point Lagrange interpolation: its error on this texture is below 1e-3 px.
  [[nodiscard]] double at(double u, double v) const {
    const int u0 = static_cast<int>(std::floor(u)) - 5, v0 = static_cast<int>(std::floor(v)) - 5;
    double wu[12], wv[12], sum = 0.0;
    for (int i = 0; i < 12; ++i) {
      wu[i] = wv[i] = 1.0;
      for (int j = 0; j < 12; ++j) {
        if (j == i) continue;
        wu[i] *= (u - u0 - j) / (i - j);
        wv[i] *= (v - v0 - j) / (i - j);
      }
    }
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 12; ++i) sum += wu[i] * wv[j] * pixel(u0 + i, v0 + j);
    }
    return sum;
  }
};

inline core::simulation::Scene still_scene() {
  core::simulation::Scene scene = core::simulation::make_paper_scene(1, 2.0);
  scene.excitation.rms_mm = 0.0;
  scene.hover.x_rms_mm = scene.hover.y_rms_mm = scene.hover.z_rms_mm = 0.0;
  return scene;
}

// 480 x 270, for tests that need no detail.
inline core::simulation::Scene small_scene(std::uint64_t seed = 1) {
  core::simulation::Scene scene = core::simulation::make_paper_scene(seed, 2.0);
  core::simulation::set_image_size(scene, 480, 270);
  return scene;
}

}  // namespace test_support
