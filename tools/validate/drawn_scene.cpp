#include "tools/validate/drawn_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/simulation/presets.h"

namespace tools {
namespace {

using core::simulation::Scene;

constexpr double kNoiseSpread = 0.35, kSigmaError = 0.15;
constexpr double kUnequalMass = 0.15, kUnequalStiffness = 0.2;  // sd of the logarithm, by storey
constexpr double kPlateOfStorey = 0.36;
constexpr double kBandOverTopMode = 1.3;

void draw_camera(Scene& scene, Draw draw) {
  scene.camera.alpha_px = std::round(draw.log_uniform(1300.0, 2800.0));
  scene.camera.rate_hz = std::round(100.0 * draw.log_uniform(24.0, 60.0)) / 100.0;
  scene.camera.readout_s = std::min(draw.uniform(0.008, 0.030), 0.95 / scene.camera.rate_hz);
}

core::simulation::StructureModel draw_structure(int n_storeys, Draw& draw) {
  core::simulation::ShearBuilding frame;
  core::simulation::ModalDamping damping;
  for (int i = 0; i < n_storeys; ++i) {
    frame.mass_kg.push_back(std::exp(kUnequalMass * draw.gaussian()));
    frame.stiffness_n_per_m.push_back(1000.0 * std::exp(kUnequalStiffness * draw.gaussian()));
    damping.ratio.push_back(draw.log_uniform(0.005, 0.02));
  }
  const double wanted_hz = draw.log_uniform(1.0, 2.0);
  const double first_hz = modes_of(core::simulation::shear_frame(frame, damping)).front().frequency_hz;
  for (double& stiffness : frame.stiffness_n_per_m) stiffness *= std::pow(wanted_hz / first_hz, 2);
  return core::simulation::shear_frame(frame, damping);
}

// Plates that stay in the image at three standard deviations of the drift; the view's height is the limit.
void draw_view(Scene& scene, int n_storeys, Draw& draw) {
  const double distance_mm = draw.log_uniform(1500.0, 3000.0), alpha_px = scene.camera.alpha_px;
  const double nearest_mm = distance_mm - 3.0 * scene.hover.z_rms_mm;
  const double room_mm = scene.camera.cy_px * nearest_mm / alpha_px - 3.0 * scene.hover.y_rms_mm;
  const double height_mm = 2.0 * room_mm * draw.uniform(0.75, 0.95);
  const double storey_mm = height_mm / (n_storeys + kPlateOfStorey);
  const double px_mm = distance_mm / alpha_px;
  scene.plates = core::simulation::tower_plates(n_storeys, draw.uniform(220.0, 420.0) * px_mm,
                                                kPlateOfStorey * storey_mm, storey_mm, distance_mm);
  scene.background.depth_mm = distance_mm * draw.uniform(1.5, 3.0);
  for (auto& plate : scene.plates) plate.texture.pitch_mm = 0.0;
  scene.background.texture.pitch_mm = 0.0;
  settle_textures(scene);
  scene.excitation.rms_mm = draw.uniform(2.5, 5.0) * px_mm;
}

}  // namespace

Draw::Draw(std::uint64_t seed, std::string_view subject) : stream_(seed, "draw." + std::string(subject)) {}

double Draw::log_uniform(double low, double high) noexcept { return low * std::pow(high / low, stream_.uniform()); }

int Draw::whole(int low, int high) noexcept {
  return std::min(high, low + static_cast<int>(std::floor((high - low + 1) * stream_.uniform())));
}

DrawnScene draw_scene(std::uint64_t seed, double duration_s) {
  DrawnScene out;
  Scene& scene = out.scene;
  scene.seed = seed;
  scene.duration_s = duration_s;
  draw_camera(scene, Draw(seed, "camera"));
  Draw structure(seed, "structure"), view(seed, "view"), noise(seed, "noise");
  const int n_storeys = structure.whole(4, 8);
  scene.structure = draw_structure(n_storeys, structure);
  draw_view(scene, n_storeys, view);
  const auto modes = modes_of(scene.structure);
  scene.excitation.band_high_hz = kBandOverTopMode * modes.back().frequency_hz;
  scene.tracks.noise_px = noise.log_uniform(0.01, 0.1);
  scene.tracks.noise_spread = kNoiseSpread;
  scene.tracks.sigma_error = kSigmaError;
  const double px_mm = scene.plates.front().z_mm / scene.camera.alpha_px;
  scene.channels.noise_mm = scene.tracks.noise_px * px_mm / std::sqrt(10.0);  // mean of ten points
  out.words = fmt::format(
      "{} storeys of {:.3f} ... {:.2f} Hz, {:.0f} px from {:.0f} mm, {:.2f} frames/s, readout {:.1f} ms, noise {:.4f} "
      "px",
      n_storeys, modes.front().frequency_hz, modes.back().frequency_hz, scene.camera.alpha_px,
      scene.plates.front().z_mm, scene.camera.rate_hz, 1e3 * scene.camera.readout_s, scene.tracks.noise_px);
  core::simulation::validate(scene);
  return out;
}

}  // namespace tools
