#include "core/simulation/presets.h"

#include <algorithm>
#include <stdexcept>

namespace core::simulation {
namespace {

constexpr double kPlatePitch_px = 2.75, kBackgroundPitch_px = 7.0;

Scene empty_scene(std::uint64_t seed, double duration_s) {
  Scene scene;
  scene.seed = seed;
  scene.duration_s = duration_s;
  return scene;
}

void fit_textures(Scene& scene) {
  for (Plate& plate : scene.plates) plate.texture.pitch_mm = 0.0;
  scene.background.texture.pitch_mm = 0.0;
  settle_textures(scene);
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

StructureDescription paper_structure() { return {UniformChain{{1.657, 5.04, 8.14, 10.83, 12.93, 14.34}}, {{0.01}}}; }

// A steel tube 0.76 m wide with walls of 8 mm, platforms and cladding included in the mass.
constexpr Cantilever kChimney{30.0e3, 8, 2.8e8, 170.0, 80.0};
StructureDescription cantilever_structure() { return {kChimney, {{0.008, 0.010, 0.012}}}; }

StructureDescription shear_frame_structure() {
  ShearBuilding frame;
  frame.mass_kg = {12.0, 11.0, 11.0, 8.0};
  frame.stiffness_n_per_m = {1.9e4, 1.6e4, 1.4e4, 1.2e4};
  return {frame, {{0.010, 0.008, 0.012, 0.015}}};
}

constexpr BridgeDeck kFootbridge{40.0e3, 7, 1, 4.494e9, 1200.0, BridgeDeck::Ends::kSimple};
StructureDescription deck_structure() { return {kFootbridge, {{0.006, 0.008, 0.010}}}; }

struct Builder {
  const ModalDamping& damping;
  StructureModel operator()(const UniformChain& chain) const {
    std::vector<double> ratio = damping.ratio;
    ratio.resize(chain.frequency_hz.size(), ratio.back());
    return uniform_chain(chain.frequency_hz, ratio);
  }
  StructureModel operator()(const ShearBuilding& frame) const { return shear_frame(frame, damping); }
  StructureModel operator()(const Cantilever& tower) const { return cantilever(tower, damping); }
  StructureModel operator()(const BridgeDeck& deck) const { return bridge_deck(deck, damping); }
};

}  // namespace

StructureModel build(const StructureDescription& description) {
  return std::visit(Builder{description.damping}, description.kind);
}

void settle_textures(Scene& scene) {
  const auto settle = [&](TextureParameters& texture, double depth_mm, double pitch_px) {
    const double mm_per_px = (depth_mm - scene.camera.z_mm) / scene.camera.alpha_px;
    if (texture.pitch_mm <= 0.0) texture.pitch_mm = std::max(0.01, pitch_px * mm_per_px);
  };
  for (Plate& plate : scene.plates) settle(plate.texture, plate.z_mm, kPlatePitch_px);
  settle(scene.background.texture, scene.background.depth_mm, kBackgroundPitch_px);
}

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
  scene.structure = build(paper_structure());
  scene.plates = tower_plates(6, 300.0, 50.0, 140.0, 2000.0);
  fit_textures(scene);
  return scene;
}

Scene make_cantilever_scene(std::uint64_t seed, double duration_s) {
  Scene scene = empty_scene(seed, duration_s);
  scene.structure = build(cantilever_structure());
  scene.plates = tower_plates(kChimney.bodies, 1500.0, 1200.0, kChimney.height_mm / kChimney.bodies, 40.0e3);
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
  scene.structure = build(shear_frame_structure());
  scene.plates = tower_plates(4, 360.0, 70.0, 200.0, 2500.0);
  scene.excitation.forces = 0.5;
  scene.excitation.rms_mm = 3.0;
  scene.background.depth_mm = 5000.0;
  fit_textures(scene);
  return scene;
}

Scene make_deck_scene(std::uint64_t seed, double duration_s) {
  Scene scene = empty_scene(seed, duration_s);
  scene.structure = build(deck_structure());
  Plate plate;
  plate.name = "base";
  plate.x_mm = -0.5 * kFootbridge.span_mm - 1200.0;
  plate.z_mm = 45.0e3;
  plate.width_mm = 2000.0;
  plate.height_mm = 900.0;
  scene.plates.push_back(plate);
  for (const double x_mm : body_positions_mm(kFootbridge)) {
    plate.name = "deck" + std::to_string(scene.plates.size());
    plate.x_mm = x_mm - 0.5 * kFootbridge.span_mm;
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
      {"paper", "six storeys on a shaking table, 1.7 to 14 Hz, 25 fps, 2 m away", paper_structure, make_paper_scene},
      {"cantilever", "30 m chimney in the wind, 0.8 to 14 Hz, 30 fps, 40 m away", cantilever_structure,
       make_cantilever_scene},
      {"shear_frame", "four unequal storeys, table and forces, 2.3 to 11 Hz, 25 fps, 2.5 m away", shear_frame_structure,
       make_shear_frame_scene},
      {"deck", "40 m footbridge, vertical, 1.9 to 17 Hz, 50 fps, 45 m away", deck_structure, make_deck_scene}};
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
