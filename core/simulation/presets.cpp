#include "core/simulation/presets.h"

#include <algorithm>
#include <stdexcept>

#include "core/simulation/beam_builders.h"
#include "core/simulation/structure_builders.h"

namespace core::simulation {
namespace {

constexpr double kPlatePitchPx = 2.75;  // content up to 0.2 cycles/px
constexpr double kBackgroundPitchPx = 7.0;

Scene empty_scene(std::uint64_t seed, double duration_s) {
  Scene scene;
  scene.seed = seed;
  scene.duration_s = duration_s;
  return scene;
}

// Every texture at its pitch in pixels.
void fit_textures(Scene& scene) {
  const CameraParameters& camera = scene.camera;
  const auto pitch_mm = [&](double pitch_px, double depth_mm) {
    return pitch_px * (depth_mm - camera.z_mm) / camera.alpha_px;
  };
  for (Plate& plate : scene.plates) plate.texture.pitch_mm = pitch_mm(kPlatePitchPx, plate.z_mm);
  scene.background.texture.pitch_mm = pitch_mm(kBackgroundPitchPx, scene.background.depth_mm);
}

// A multicopter on satellite positioning with a gimbal, in light wind.
HoverParameters outdoor_hover() {
  HoverParameters hover;
  hover.x_rms_mm = hover.z_rms_mm = 120.0;
  hover.y_rms_mm = 80.0;
  hover.pitch_rms_rad = hover.yaw_rms_rad = hover.roll_rms_rad = 2e-4;
  return hover;
}

// A 24 mm lens (of a 36 mm wide film) in daylight.
CameraParameters outdoor_camera() {
  CameraParameters camera;
  camera.alpha_px = 1300.0;
  camera.rate_hz = 30.0;
  camera.readout_s = 0.020;
  camera.exposure_s = 0.002;
  return camera;
}

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
  Scene scene = empty_scene(seed, duration_s);
  scene.structure = uniform_chain({1.657, 5.04, 8.14, 10.83, 12.93, 14.34}, std::vector<double>(6, 0.01));
  scene.plates = tower_plates(6, 300.0, 50.0, 140.0, 2000.0);
  fit_textures(scene);
  return scene;
}

Scene make_cantilever_scene(std::uint64_t seed, double duration_s) {
  constexpr int kBodies = 8;
  constexpr double kHeight_mm = 30.0e3;
  Scene scene = empty_scene(seed, duration_s);
  // A steel tube 0.76 m wide with walls of 8 mm, platforms and cladding included in the mass.
  scene.structure = cantilever({kHeight_mm, kBodies, 2.8e8, 170.0, 80.0}, ModalDamping{{0.008, 0.010, 0.012}});
  scene.plates = tower_plates(kBodies, 1500.0, 1200.0, kHeight_mm / kBodies, 40.0e3);
  for (std::size_t i = 1; i < scene.plates.size(); ++i) scene.plates[i].name = "section" + std::to_string(i);
  scene.camera = outdoor_camera();
  scene.hover = outdoor_hover();
  scene.background.depth_mm = 90.0e3;
  scene.excitation.base = 0.0;
  scene.excitation.forces = 1.0;
  scene.excitation.band_low_hz = 0.2;
  scene.excitation.rms_mm = 25.0;
  fit_textures(scene);
  return scene;
}

Scene make_shear_frame_scene(std::uint64_t seed, double duration_s) {
  Scene scene = empty_scene(seed, duration_s);
  ShearFrame frame;
  frame.mass_kg = {12.0, 11.0, 11.0, 8.0};
  frame.stiffness_n_per_m = {1.9e4, 1.6e4, 1.4e4, 1.2e4};
  scene.structure = shear_frame(frame, ModalDamping{{0.010, 0.008, 0.012, 0.015}});
  scene.plates = tower_plates(4, 360.0, 70.0, 200.0, 2500.0);
  scene.excitation.forces = 0.5;
  scene.excitation.rms_mm = 3.0;
  scene.background.depth_mm = 5000.0;
  fit_textures(scene);
  return scene;
}

Scene make_deck_scene(std::uint64_t seed, double duration_s) {
  BridgeDeck deck;
  deck.span_mm = 40.0e3;
  deck.bodies = 7;
  deck.bending_stiffness_n_m2 = 4.494e9;
  deck.mass_kg_per_m = 1200.0;
  Scene scene = empty_scene(seed, duration_s);
  scene.structure = bridge_deck(deck, ModalDamping{{0.006, 0.008, 0.010}});
  Plate plate;
  plate.name = "base";
  plate.x_mm = -0.5 * deck.span_mm - 1200.0;
  plate.z_mm = 45.0e3;
  plate.width_mm = 2000.0;
  plate.height_mm = 900.0;
  scene.plates.push_back(plate);
  for (const double x_mm : body_positions_mm(deck)) {
    plate.name = "deck" + std::to_string(scene.plates.size());
    plate.x_mm = x_mm - 0.5 * deck.span_mm;
    scene.plates.push_back(plate);
  }
  scene.camera = outdoor_camera();
  scene.camera.alpha_px = 1800.0;  // zoomed in
  scene.camera.rate_hz = 50.0;
  scene.camera.readout_s = 0.012;
  scene.hover = outdoor_hover();
  scene.background.depth_mm = 80.0e3;
  scene.excitation.base = 0.0;
  scene.excitation.forces = 1.0;
  scene.excitation.rms_mm = 2.0;  // of the last eighth of the span; its middle moves about 2.4 times as much
  fit_textures(scene);
  return scene;
}

const std::vector<PresetInfo>& presets() {
  static const std::vector<PresetInfo> kPresets{
      {"paper", "six storeys on a shaking table, 1.7 to 14 Hz, 25 fps, 2 m away", make_paper_scene},
      {"cantilever", "30 m chimney in the wind, 0.8 to 14 Hz, 30 fps, 40 m away", make_cantilever_scene},
      {"shear_frame", "four unequal storeys, table and forces, 2.3 to 11 Hz, 25 fps, 2.5 m away",
       make_shear_frame_scene},
      {"deck", "40 m footbridge, vertical, 1.9 to 17 Hz, 50 fps, 45 m away", make_deck_scene}};
  return kPresets;
}

Scene make_preset(const std::string& name, std::uint64_t seed, double duration_s) {
  std::string names;
  for (const PresetInfo& preset : presets()) {
    if (preset.name == name) return preset.make(seed, duration_s);
    names += (names.empty() ? "" : ", ") + preset.name;
  }
  throw std::invalid_argument("simulation: preset is '" + name + "'; give one of " + names);
}

void set_image_size(Scene& scene, int width_px, int height_px) {
  CameraParameters& camera = scene.camera;
  const double factor =
      std::min(static_cast<double>(width_px) / camera.width_px, static_cast<double>(height_px) / camera.height_px);
  camera.alpha_px *= factor;
  camera.cx_px = 0.5 * (width_px - 1) + factor * (camera.cx_px - 0.5 * (camera.width_px - 1));
  camera.cy_px = 0.5 * (height_px - 1) + factor * (camera.cy_px - 0.5 * (camera.height_px - 1));
  camera.width_px = width_px;
  camera.height_px = height_px;
  for (Plate& plate : scene.plates) plate.texture.pitch_mm /= factor;
  scene.background.texture.pitch_mm /= factor;
}

}  // namespace core::simulation
