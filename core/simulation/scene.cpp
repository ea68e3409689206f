#include "core/simulation/scene.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace core::simulation {
namespace {

constexpr int kFullWidth = 1920, kFullHeight = 1080;
constexpr double kFullAlpha = 2100.0;
constexpr double kPlatePitchPx = 2.75;  // content up to 0.2 cycles/px
constexpr double kBackgroundPitchPx = 7.0;

void require(bool ok, const std::string& what, double value, const std::string& advice) {
  if (!ok) throw std::invalid_argument("simulation: " + what + " is " + std::to_string(value) + "; " + advice);
}

void require_range(const std::string& what, double value, double low, double high) {
  require(value >= low && value <= high, what, value,
          "give a value from " + std::to_string(low) + " to " + std::to_string(high));
}

void validate_camera(const CameraParameters& camera) {
  require_range("image width (px)", camera.width_px, 320, 8192);
  require_range("image height (px)", camera.height_px, 180, 8192);
  require_range("alpha (px)", camera.alpha_px, 10.0, 1e5);
  require_range("cx (px)", camera.cx_px, 0.0, camera.width_px);
  require_range("cy (px)", camera.cy_px, 0.0, camera.height_px);
  require_range("frame rate (Hz)", camera.rate_hz, 1.0, 1e4);
  require_range("readout (s)", camera.readout_s, 0.0, 1.0 / camera.rate_hz);
  require_range("exposure (s)", camera.exposure_s, 0.0, 1.0 / camera.rate_hz);
  require_range("noise (grey levels)", camera.noise_sigma, 0.0, 100.0);
}

void validate_structure(const StructureParameters& structure) {
  require_range("number of storeys", structure.n_floors(), 1, 40);
  require(structure.damping_ratio.size() == structure.frequency_hz.size(), "number of damping ratios",
          static_cast<double>(structure.damping_ratio.size()), "give one for each frequency");
  for (const double f : structure.frequency_hz) require_range("natural frequency (Hz)", f, 0.01, 1e3);
  for (const double z : structure.damping_ratio) require_range("damping ratio", z, 1e-4, 0.5);
  require_range("lower end of the input band (Hz)", structure.band_low_hz, 0.01, 1e3);
  require_range("upper end of the input band (Hz)", structure.band_high_hz, 1.01 * structure.band_low_hz, 1e3);
  require_range("roof displacement (mm rms)", structure.roof_rms_mm, 0.0, 1e3);
}

void validate_texture(const TextureParameters& texture) {
  require_range("texture pitch (mm)", texture.pitch_mm, 0.01, 1e4);
  require_range("texture mean (grey levels)", texture.mean, 0.0, 255.0);
  require_range("texture contrast (grey levels rms)", texture.contrast_rms, 0.0, 128.0);
}

void validate_hover(const HoverParameters& hover) {
  for (const double rms : {hover.x_rms_mm, hover.y_rms_mm, hover.z_rms_mm})
    require_range("drift (mm rms)", rms, 0.0, 1e4);
  for (const double rms : {hover.pitch_rms_rad, hover.yaw_rms_rad, hover.roll_rms_rad}) {
    require_range("rotation (rad rms)", rms, 0.0, 0.1);
  }
  require_range("corner of the drift (Hz)", hover.corner_hz, 0.001, 100.0);
  require_range("order of the drift", hover.order, 2.0, 24.0);
  require_range("upper limit of the drift (Hz)", hover.limit_hz, hover.corner_hz, 100.0);
}

// Three standard deviations of every motion at once, each at its worst sign.
void validate_view(const Scene& s) {
  const double near_mm = s.plates.depth_mm - 3.0 * s.hover.z_rms_mm;
  require(s.hover.z_rms_mm <= 0.1 * s.plates.depth_mm, "drift towards the structure (mm rms)", s.hover.z_rms_mm,
          "give at most a tenth of the stand-off");
  const double scale = s.camera.alpha_px / near_mm;
  const double tilt = 3.0 * s.camera.alpha_px;
  const double half_u = scale * (s.plates.width_mm / 2 + 3.0 * s.hover.x_rms_mm + 4.0 * s.structure.roof_rms_mm) +
                        tilt * s.hover.yaw_rms_rad;
  const double half_v = scale * (std::abs(s.body_y_mm(0)) + s.plates.height_mm / 2 + 3.0 * s.hover.y_rms_mm) +
                        tilt * s.hover.pitch_rms_rad;
  const double room_u = std::min(s.camera.cx_px, s.camera.width_px - 1 - s.camera.cx_px);
  const double room_v = std::min(s.camera.cy_px, s.camera.height_px - 1 - s.camera.cy_px);
  const std::string advice = "reduce alpha, the storey height or the drift, or stand further back";
  require(half_u <= room_u, "half width of the structure with 3 sigma of drift (px)", half_u, advice);
  require(half_v <= room_v, "half height of the structure with 3 sigma of drift (px)", half_v, advice);
}

}  // namespace

std::uint64_t Scene::n_frames() const noexcept {
  const double frames = std::floor(duration_s * camera.rate_hz + 1e-6);
  return frames >= 1.0 ? static_cast<std::uint64_t>(frames) : 0;
}

// The stack is centred on the optical axis; the base is lowest (Y down).
double Scene::body_y_mm(int body) const noexcept { return plates.storey_mm * (0.5 * structure.n_floors() - body); }

core::CameraInfo Scene::camera_info() const {
  core::CameraInfo info;
  info.width_px = camera.width_px;
  info.height_px = camera.height_px;
  info.rate_hz = camera.rate_hz;
  info.readout_ns = std::llround(camera.readout_s * 1e9);
  info.readout_direction = core::ReadoutDirection::kDown;
  info.exposure_ns = std::llround(camera.exposure_s * 1e9);
  info.frame_count = n_frames();
  info.description = "simulated shear building, seed " + std::to_string(seed);
  return info;
}

Scene make_paper_scene(std::uint64_t seed, double duration_s) {
  Scene scene;
  scene.seed = seed;
  scene.duration_s = duration_s;
  scene.structure.frequency_hz = {1.657, 5.04, 8.14, 10.83, 12.93, 14.34};
  scene.structure.damping_ratio.assign(6, 0.01);
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
  scene.plates.texture.pitch_mm = kPlatePitchPx * scene.plates.depth_mm / camera.alpha_px;
  scene.background.texture.pitch_mm = kBackgroundPitchPx * scene.background.depth_mm / camera.alpha_px;
}

void validate(const Scene& scene) {
  require(std::isfinite(scene.duration_s) && scene.duration_s > 0.0, "duration (s)", scene.duration_s,
          "give a positive number of seconds");
  require(scene.duration_s <= 21600.0, "duration (s)", scene.duration_s, "give at most six hours (21600 s)");
  validate_camera(scene.camera);
  require(scene.n_frames() >= 1, "duration (s)", scene.duration_s,
          "give at least one frame, " + std::to_string(1.0 / scene.camera.rate_hz) + " s");
  validate_structure(scene.structure);
  validate_hover(scene.hover);
  require_range("plate width (mm)", scene.plates.width_mm, 1.0, 1e5);
  require_range("plate height (mm)", scene.plates.height_mm, 1.0, 1e5);
  require_range("storey height (mm)", scene.plates.storey_mm, scene.plates.height_mm, 1e5);
  require_range("stand-off (mm)", scene.plates.depth_mm, 100.0, 1e6);
  require_range("depth of the background (mm)", scene.background.depth_mm, scene.plates.depth_mm, 1e7);
  validate_texture(scene.plates.texture);
  validate_texture(scene.background.texture);
  validate_view(scene);
}

}  // namespace core::simulation
