#include "tools/validate/render.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>

#include "core/simulation/camera/light.h"
#include "core/simulation/presets.h"
#include "core/simulation/render/render_reference.h"
#include "core/simulation/render/renderer.h"

namespace tools {
namespace {

using core::simulation::LensParameters;
using core::simulation::Light;
using core::simulation::Renderer;
using core::simulation::RenderReference;
using core::simulation::Scene;

constexpr int kInstants = 64, kPoints = 256;

class Sum {
 public:
  void add(double error) {
    worst_ = std::max(worst_, std::abs(error));
    sum2_ += error * error;
    ++n_;
  }
  [[nodiscard]] ReferenceError result(std::string name) const {
    return {std::move(name), worst_, std::sqrt(sum2_ / std::max(1, n_)), n_};
  }

 private:
  double worst_ = 0.0, sum2_ = 0.0;
  int n_ = 0;
};

// Small, so that brute force takes acceptable time; fast motion.
Scene moving_scene(std::uint64_t seed) {
  Scene scene = core::simulation::make_paper_scene(seed, 10.0);
  core::simulation::set_image_size(scene, 480, 270);
  scene.camera.exposure_s = 0.03;  // about a pixel of motion
  scene.excitation.rms_mm = 10.0;
  scene.camera.alpha_px *= 0.9;  // room for rotation
  scene.hover.y_rms_mm = 4.0;
  return scene;
}

Scene turned_scene(std::uint64_t seed) {
  Scene scene = moving_scene(seed);
  scene.camera.roll_rad = 0.09;
  scene.camera.pitch_rad = 0.01;
  scene.hover.roll_rms_rad = scene.hover.yaw_rms_rad = 0.002;
  scene.hover.zoom_rms = 0.001;
  scene.camera.lens = {LensParameters::Model::kRadialTangential, {-0.15, 0.03, 1e-3, -5e-4, 0.0}};
  return scene;
}

std::vector<float> light_of(const Renderer& renderer, double t_frame_s) {
  const auto& camera = renderer.scene().camera;
  std::vector<float> light(static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px));
  renderer.render_light(t_frame_s, light.data());
  return light;
}

// Whether an edge comes near the pixel during the exposure.
bool near_edge(const RenderReference& reference, double t_frame_s, int u, int v) {
  constexpr double kMargin_px = 2.0;
  const Scene& scene = reference.motion().scene();
  const core::simulation::ImagePoint pixel{static_cast<double>(u), static_cast<double>(v)};
  const double t_s = reference.motion().line_time_s(t_frame_s, pixel);
  for (int body = 0; body < scene.n_bodies(); ++body) {
    const auto& plate = scene.plates[static_cast<std::size_t>(body)];
    const double margin_mm = kMargin_px * plate.z_mm / scene.camera.alpha_px;
    const auto point = reference.place(body, pixel, t_s);
    const double x = std::abs(point.x_mm) - 0.5 * plate.width_mm, y = std::abs(point.y_mm) - 0.5 * plate.height_mm;
    if (std::max(x, y) < margin_mm && std::max(x, y) > -margin_mm) return true;
  }
  return false;
}

ReferenceError compare(std::string name, const Scene& scene, bool edges) {
  const Renderer renderer(scene);
  const RenderReference reference(scene);
  const double t_frame_s = 3.0;
  const std::vector<float> light = light_of(renderer, t_frame_s);
  Sum sum;
  const int stride = edges ? 1 : 7;
  int n_near = 0;
  for (int v = 3; v < scene.camera.height_px; v += stride) {
    for (int u = 2; u < scene.camera.width_px; u += stride) {
      if (near_edge(reference, t_frame_s, u, v) != edges) continue;
      if (edges && ++n_near % 13 != 0) continue;
      const double wanted = reference.grey(t_frame_s, u, v, edges ? 16 : kInstants, edges ? kPoints : 1);
      sum.add(static_cast<double>(light[static_cast<std::size_t>(v * scene.camera.width_px + u)]) - wanted);
    }
  }
  return sum.result(std::move(name));
}

Scene flat(Scene scene) {
  for (auto& plate : scene.plates) plate.texture.mean = 180.0, plate.texture.contrast_rms = 1e-6;
  scene.background.texture.mean = 80.0;
  scene.background.texture.contrast_rms = 1e-6;
  return scene;
}

std::vector<double> row_means(const Scene& scene) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(scene.camera.width_px * scene.camera.height_px));
  Renderer(scene).render(std::uint64_t{5}, pixels.data());
  std::vector<double> means;
  for (auto row = pixels.begin(); row != pixels.end(); row += scene.camera.width_px) {
    double sum = 0.0;
    std::for_each(row, row + scene.camera.width_px, [&sum](std::uint8_t grey) { sum += grey; });
    means.push_back(sum / scene.camera.width_px);
  }
  return means;
}

double frames_per_s(const Scene& scene, Renderer::Way way, int n_threads) {
  constexpr std::uint64_t kFrames = 24;
  const Renderer renderer(scene, way);
  std::vector<std::thread> threads;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < n_threads; ++i) {
    threads.emplace_back([&] {
      Renderer::Scratch scratch = renderer.make_scratch();
      std::vector<std::uint8_t> pixels(static_cast<std::size_t>(scene.camera.width_px * scene.camera.height_px));
      for (std::uint64_t frame = 0; frame < kFrames; ++frame) renderer.render(frame, pixels.data(), scratch);
    });
  }
  for (std::thread& thread : threads) thread.join();
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  return static_cast<double>(kFrames) * n_threads / elapsed.count();
}

}  // namespace

std::vector<ReferenceError> check_reference_pixels(std::uint64_t seed) {
  Scene still = moving_scene(seed);
  still.camera.exposure_s = 0.0;
  Scene still_turned = turned_scene(seed);
  still_turned.camera.exposure_s = 0.0;
  return {compare("insides, straight", moving_scene(seed), false),
          compare("insides, turned, lens, zoom", turned_scene(seed), false),
          compare("edges, straight, still", flat(still), true),
          compare("edges, straight, blurred", flat(moving_scene(seed)), true),
          compare("edges, turned, lens, still", flat(still_turned), true),
          compare("edges, turned, lens, blurred", flat(turned_scene(seed)), true)};
}

double check_flicker_bands(std::uint64_t seed) {
  Scene scene = core::simulation::make_paper_scene(seed, 4.0);
  const std::vector<double> steady = row_means(scene);
  scene.light.flicker_depth = 0.2;
  const std::vector<double> lit = row_means(scene);
  const Light light(scene);
  const core::simulation::SceneMotion motion(scene);
  double worst = 0.0;
  for (std::size_t v = 0; v < lit.size(); ++v) {
    const double t_s = motion.line_time_s(5.0 / scene.camera.rate_hz, {0.0, static_cast<double>(v)});
    worst = std::max(worst, std::abs(lit[v] / steady[v] - light.factor(t_s)));
  }
  return worst;
}

std::vector<RenderSpeed> check_render_speed(std::uint64_t seed, int n_threads) {
  const Scene plain = core::simulation::make_paper_scene(seed, 10.0);
  Scene turned = plain;
  turned.camera.roll_rad = 0.05;
  turned.hover.roll_rms_rad = 0.001;
  Scene lens = turned;
  lens.camera.lens = {LensParameters::Model::kRadialTangential, {-0.1, 0.02, 1e-4, 1e-4, 0.0}};
  return {{"straight", frames_per_s(plain, Renderer::Way::kQuickest, n_threads)},
          {"turned", frames_per_s(turned, Renderer::Way::kQuickest, n_threads)},
          {"turned, through a lens", frames_per_s(lens, Renderer::Way::kQuickest, n_threads)}};
}

}  // namespace tools
