#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "core/simulation/camera/projection.h"
#include "core/simulation/injected/validation.h"
#include "core/simulation/scene.h"

namespace core::simulation {
namespace {

void require(bool ok, const std::string& what, double value, const std::string& advice) {
  if (!ok) throw std::invalid_argument("simulation: " + what + " is " + std::to_string(value) + "; " + advice);
}

void require_range(const std::string& what, double value, double low, double high) {
  require(value >= low && value <= high, what, value,
          "give a value from " + std::to_string(low) + " to " + std::to_string(high));
}

void validate_camera(const CameraParameters& camera) {
  require_range("image width (px)", camera.width_px, 160, 8192);
  require_range("image height (px)", camera.height_px, 160, 8192);
  require_range("alpha (px)", camera.alpha_px, 10.0, 1e5);
  require_range("cx (px)", camera.cx_px, 0.0, camera.width_px);
  require_range("cy (px)", camera.cy_px, 0.0, camera.height_px);
  require_range("frame rate (Hz)", camera.rate_hz, 1.0, 1e4);
  require_range("readout (s)", camera.readout_s, 0.0, 1.0 / camera.rate_hz);
  require_range("exposure (s)", camera.exposure_s, 0.0, 1.0 / camera.rate_hz);
  require_range("noise (grey levels)", camera.noise_sigma, 0.0, 100.0);
  for (const double k : camera.lens.k) require_range("lens coefficient", k, -10.0, 10.0);
  for (const double mm : {camera.x_mm, camera.y_mm, camera.z_mm}) require_range("camera position (mm)", mm, -1e7, 1e7);
  require_range("mean pitch (rad)", camera.pitch_rad, -1.2, 1.2);
  require_range("mean yaw (rad)", camera.yaw_rad, -1.2, 1.2);
  require_range("mean roll (rad)", camera.roll_rad, -3.2, 3.2);
}

void validate_excitation(const ExcitationParameters& excitation, int n_bodies) {
  require_range("weight of the base motion", excitation.base, 0.0, 1e6);
  require_range("weight of the forces", excitation.forces, 0.0, 1e6);
  require_range("lower end of the input band (Hz)", excitation.band_low_hz, 0.01, 1e3);
  require_range("upper end of the input band (Hz)", excitation.band_high_hz, 1.01 * excitation.band_low_hz, 1e3);
  require_range("displacement of the last body (mm rms)", excitation.rms_mm, 0.0, 1e4);
  for (const auto& peak : excitation.base_peaks) {
    require_range("frequency of a base peak (Hz)", peak.frequency_hz, 0.01, 1e3);
    require_range("damping of a base peak", peak.damping_ratio, 1e-4, 1.0);
    require_range("gain of a base peak", peak.gain, 0.0, 1e3);
  }
  for (const auto& harmonic : excitation.harmonics) {
    require_range("body that a harmonic force shakes", harmonic.body, 1, n_bodies - 1);
    require_range("frequency of a harmonic force (Hz)", harmonic.frequency_hz, 0.01, 1e3);
    require_range("response to a harmonic force (mm rms)", harmonic.rms_mm, 0.0, 1e4);
  }
}

void validate_texture(const std::string& of, const TextureParameters& texture, TextureParameters::Shows other) {
  if (texture.shows != TextureParameters::Shows::kNoise && texture.shows != other) {
    throw std::invalid_argument("simulation: " + of +
                                " cannot show this: a facade is a plate's, a landscape the background's");
  }
  require_range("texture pitch of " + of + " (mm)", texture.pitch_mm, 0.01, 1e5);
  require_range("texture mean of " + of + " (grey levels)", texture.mean, 0.0, 255.0);
  require(texture.contrast_rms > 0.0 && texture.contrast_rms <= 128.0,
          "texture contrast of " + of + " (grey levels rms)", texture.contrast_rms,
          "give more than 0, or nothing can be tracked there, to 128");
}

// Plates at one depth would intersect in the image.
void require_apart(const Plate& a, const Plate& b) {
  if (std::abs(a.z_mm - b.z_mm) >= 1.0) return;
  const double gap_mm = std::max(std::abs(a.x_mm - b.x_mm) - 0.5 * (a.width_mm + b.width_mm),
                                 std::abs(a.y_mm - b.y_mm) - 0.5 * (a.height_mm + b.height_mm));
  require(gap_mm >= 0.0, "gap between plates " + a.name + " and " + b.name + " (mm)", gap_mm,
          "they overlap: give smaller plates or a larger distance");
}

void validate_plates(const Scene& scene) {
  if (scene.n_bodies() != scene.structure.n_bodies() + 1) {
    throw std::invalid_argument("simulation: " + std::to_string(scene.n_bodies()) + " plates for " +
                                std::to_string(scene.structure.n_bodies()) +
                                " bodies; give one plate for the ground and one for each body");
  }
  for (const Plate& plate : scene.plates) {
    require_range("width of plate " + plate.name + " (mm)", plate.width_mm, 1.0, 1e6);
    require_range("height of plate " + plate.name + " (mm)", plate.height_mm, 1.0, 1e6);
    for (const double mm : {plate.x_mm, plate.y_mm})
      require_range("place of plate " + plate.name + " (mm)", mm, -1e7, 1e7);
    require_range("depth of plate " + plate.name + " (mm)", plate.z_mm, -1e7, 1e7);
    require(scene.background.depth_mm >= plate.z_mm, "depth of the background (mm)", scene.background.depth_mm,
            "give at least that of plate " + plate.name + ", " + std::to_string(plate.z_mm));
    validate_texture("plate " + plate.name, plate.texture, TextureParameters::Shows::kFacade);
    for (const Plate* other = scene.plates.data(); other != &plate; ++other) require_apart(*other, plate);
  }
  require_range("depth of the background (mm)", scene.background.depth_mm, 1.0, 1e8);
  validate_texture("the background", scene.background.texture, TextureParameters::Shows::kLandscape);
}

void validate_hover(const HoverParameters& hover) {
  for (const double rms : {hover.x_rms_mm, hover.y_rms_mm, hover.z_rms_mm}) {
    require_range("drift (mm rms)", rms, 0.0, 1e5);
  }
  for (const double rms : {hover.pitch_rms_rad, hover.yaw_rms_rad, hover.roll_rms_rad}) {
    require_range("rotation (rad rms)", rms, 0.0, 0.1);
  }
  require_range("zoom (rms)", hover.zoom_rms, 0.0, 0.05);
  require_range("corner of the drift (Hz)", hover.corner_hz, 0.001, 100.0);
  require_range("order of the drift", hover.order, 2.0, 24.0);
  require_range("upper limit of the drift (Hz)", hover.limit_hz, hover.corner_hz, 100.0);
}

void validate_effects(const Scene& s) {
  require_range("rotor rate (Hz)", s.rotor.frequency_hz, 1.0, 1e3);
  require_range("wander of the rotor rate (Hz rms)", s.rotor.wander_rms_hz, 0.0, 50.0);
  require_range("corner of that wander (Hz)", s.rotor.wander_corner_hz, 0.001, 10.0);
  for (const double rms : {s.rotor.pitch_rms_rad, s.rotor.yaw_rms_rad, s.rotor.roll_rms_rad}) {
    require_range("vibration by the rotors (rad rms)", rms, 0.0, 0.01);
  }
  require_range("drift of the frequencies", s.change.frequency_drift, -0.5, 0.5);
  require_range("softening", s.change.softening, -0.15, 0.15);
  require_range("jitter (s rms)", s.timing.jitter_rms_s, 0.0, 0.2 / s.camera.rate_hz);
  require_range("probability of a drop", s.timing.drop_probability, 0.0, 0.5);
  require_range("probability of a duplicate", s.timing.duplicate_probability, 0.0, 0.5);
  require_range("gain of the light (rms)", s.light.gain_rms, 0.0, 0.3);
  require_range("corner of the light's gain (Hz)", s.light.gain_corner_hz, 0.001, 10.0);
  require_range("depth of the flicker", s.light.flicker_depth, 0.0, 0.9);
  require_range("rate of the flicker (Hz)", s.light.flicker_hz, 0.1, 1e4);
  require_range("wander of the flicker (Hz)", s.light.flicker_wander_hz, 0.0, 1.0);
  require_range("points per region", s.tracks.points_per_region, 1, 10000);
  require_range("track noise (px)", s.tracks.noise_px, 0.0, 100.0);
  require_range("spread of the track noise over the points", s.tracks.noise_spread, 0.0, 2.0);
  require_range("error of the stated track noise", s.tracks.sigma_error, 0.0, 2.0);
  require_range("loss probability of a point", s.tracks.loss_probability, 0.0, 1.0);
  require_range("pixel locking (px)", s.tracks.pixel_locking_px, 0.0, 1.0);
  require_range("error by zoom (px)", s.tracks.template_zoom_px, 0.0, 100.0);
  require_range("bias by brightness (px)", s.tracks.brightness_bias_px, 0.0, 100.0);
  require_range("channel noise (mm)", s.channels.noise_mm, 0.0, 1e4);
  require_range("loss probability of a channel", s.channels.loss_probability, 0.0, 1.0);
}

// Largest deviation of the camera from its mean pose: three standard deviations of the drift, all of a recorded flight.
std::array<double, 6> reach_of(const Scene& s) {
  const HoverParameters& hover = s.hover;
  const TailedHoverParameters& tails = s.tailed_hover;
  std::array<double, 6> reach{hover.x_rms_mm,      hover.y_rms_mm,    hover.z_rms_mm,
                              hover.pitch_rms_rad, hover.yaw_rms_rad, hover.roll_rms_rad};
  for (std::size_t i = 0; i < 3; ++i) {
    reach[i] = 3.0 * std::hypot(reach[i], tails.rms_mm[i], s.vibration.rms_mm[i]);
    reach[3 + i] = 3.0 * std::hypot(reach[3 + i], tails.rms_rad[i], s.vibration.rms_rad[i]);
  }
  if (s.flight == nullptr) return reach;
  const std::array axes{&s.flight->x_mm,      &s.flight->y_mm,    &s.flight->z_mm,
                        &s.flight->pitch_rad, &s.flight->yaw_rad, &s.flight->roll_rad};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (const double value : *axes[i]) reach[i] = std::max(reach[i], std::abs(value));
  }
  return reach;
}

// All motions at their largest deviation and worst sign at once.
void validate_view(const Scene& s) {
  const std::array<double, 6> reach = reach_of(s);
  double low_u = 1e18, high_u = -1e18, low_v = 1e18, high_v = -1e18;
  double shake = 4.0 * s.excitation.rms_mm * std::hypot(s.excitation.base, s.excitation.forces);
  for (const auto& harmonic : s.excitation.harmonics) shake += 1.5 * harmonic.rms_mm;
  const bool along_x = s.structure.axis == StructureModel::Axis::kX;
  for (int signs = 0; signs < 256; ++signs) {
    const auto sign = [signs](int bit) { return (signs >> bit & 1) != 0 ? 1.0 : -1.0; };
    CameraPose pose{s.camera.x_mm + sign(0) * reach[0], s.camera.y_mm + sign(1) * reach[1],
                    s.camera.z_mm + sign(2) * reach[2],
                    attitude(s.camera.pitch_rad, s.camera.yaw_rad, s.camera.roll_rad) *
                        attitude(sign(3) * reach[3], sign(4) * reach[4], sign(5) * reach[5]),
                    1.0};
    for (std::size_t i = 0; i < s.plates.size(); ++i) {
      const Plate& plate = s.plates[i];
      const double moved = i == 0 ? 0.0 : shake;
      const double x = plate.x_mm + sign(6) / 2.0 * plate.width_mm + (along_x ? sign(6) * moved : 0.0);
      const double y = plate.y_mm + sign(7) / 2.0 * plate.height_mm + (along_x ? 0.0 : sign(7) * moved);
      const Eigen::Vector3d seen =
          pose.attitude.transpose() * Eigen::Vector3d(x - pose.x_mm, y - pose.y_mm, plate.z_mm - pose.z_mm);
      require(seen.z() >= 50.0, "distance from the camera to plate " + plate.name + " with 3 sigma of drift (mm)",
              seen.z(), "the camera is in or behind the structure: give a larger depth, or less drift towards it");
      const ImagePoint image = project(s.camera, pose, x, y, plate.z_mm);
      low_u = std::min(low_u, image.u_px), high_u = std::max(high_u, image.u_px);
      low_v = std::min(low_v, image.v_px), high_v = std::max(high_v, image.v_px);
    }
  }
  const std::string advice = " px; it leaves the image. Reduce alpha, the structure's size or the drift, or stand back";
  require(low_u >= 0.0, "left edge of the structure with 3 sigma of drift", low_u, "give 0" + advice);
  require(high_u <= s.camera.width_px - 1, "right edge of the structure with 3 sigma of drift", high_u,
          "give " + std::to_string(s.camera.width_px - 1) + advice);
  require(low_v >= 0.0, "top edge of the structure with 3 sigma of drift", low_v, "give 0" + advice);
  require(high_v <= s.camera.height_px - 1, "bottom edge of the structure with 3 sigma of drift", high_v,
          "give " + std::to_string(s.camera.height_px - 1) + advice);
}

}  // namespace

std::uint64_t Scene::n_frames() const noexcept {
  const double frames = std::floor(duration_s * camera.rate_hz + 1e-6);
  return frames >= 1.0 ? static_cast<std::uint64_t>(frames) : 0;
}

core::CameraInfo Scene::camera_info() const {
  core::CameraInfo info;
  info.width_px = camera.width_px;
  info.height_px = camera.height_px;
  info.rate_hz = camera.rate_hz;
  info.readout_ns = std::llround(camera.readout_s * 1e9);
  info.readout_direction = camera.readout_direction;
  info.exposure_ns = std::llround(camera.exposure_s * 1e9);
  info.frame_count = n_frames();
  info.description = "simulated structure, seed " + std::to_string(seed);
  return info;
}

void validate(const Scene& scene) {
  require(std::isfinite(scene.duration_s) && scene.duration_s > 0.0, "duration (s)", scene.duration_s,
          "give a positive number of seconds");
  require(scene.duration_s <= 21600.0, "duration (s)", scene.duration_s, "give at most six hours (21600 s)");
  validate_camera(scene.camera);
  require(scene.n_frames() >= 1, "duration (s)", scene.duration_s,
          "give at least one frame, " + std::to_string(1.0 / scene.camera.rate_hz) + " s");
  validate(scene.structure);
  validate_excitation(scene.excitation, scene.n_bodies());
  validate_hover(scene.hover);
  validate_injected(scene);
  validate_plates(scene);
  validate_effects(scene);
  validate_view(scene);
}

}  // namespace core::simulation
