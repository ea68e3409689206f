#include "core/simulation/presets.h"

#include <algorithm>

namespace core::simulation {
namespace {

constexpr int kFullWidth = 1920, kFullHeight = 1080;
constexpr double kFullAlpha = 2100.0;
constexpr double kPlatePitchPx = 2.75;  // content up to 0.2 cycles/px
constexpr double kBackgroundPitchPx = 7.0;

}  // namespace

std::vector<Plate> tower_plates(int n_floors, double width_mm, double height_mm, double storey_mm, double depth_mm) {
  std::vector<Plate> plates;
  for (int body = 0; body <= n_floors; ++body) {
    Plate plate;
    plate.name = body == 0 ? "base" : "floor" + std::to_string(body);
    plate.y_mm = storey_mm * (0.5 * n_floors - body);
    plate.z_mm = depth_mm;
    plate.width_mm = width_mm;
    plate.height_mm = height_mm;
    plates.push_back(plate);
  }
  return plates;
}

Scene make_paper_scene(std::uint64_t seed, double duration_s) {
  Scene scene;
  scene.seed = seed;
  scene.duration_s = duration_s;
  scene.structure = uniform_chain({1.657, 5.04, 8.14, 10.83, 12.93, 14.34}, std::vector<double>(6, 0.01));
  scene.plates = tower_plates(6, 300.0, 50.0, 140.0, 2000.0);
  set_image_size(scene, kFullWidth, kFullHeight);
  return scene;
}

void set_image_size(Scene& scene, int width_px, int height_px) {
  const double factor =
      std::min(static_cast<double>(width_px) / kFullWidth, static_cast<double>(height_px) / kFullHeight);
  CameraParameters& camera = scene.camera;
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.alpha_px = kFullAlpha * factor;
  camera.cx_px = 0.5 * (width_px - 1);
  camera.cy_px = 0.5 * (height_px - 1);
  for (Plate& plate : scene.plates) plate.texture.pitch_mm = kPlatePitchPx * plate.z_mm / camera.alpha_px;
  scene.background.texture.pitch_mm = kBackgroundPitchPx * scene.background.depth_mm / camera.alpha_px;
}

}  // namespace core::simulation
