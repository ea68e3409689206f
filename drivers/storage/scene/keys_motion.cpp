#include <utility>

#include "core/types/constants.h"
#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

using core::kDegPerRad;
using core::simulation::Scene;
using H = core::simulation::HoverParameters;
using R = core::simulation::RotorParameters;
using Ti = core::simulation::TimingParameters;
using Chg = core::simulation::ChangeParameters;
using L = core::simulation::LightParameters;
using T = core::simulation::TrackParameters;
using Ch = core::simulation::ChannelParameters;
using F = SceneFlight;
using D = SceneDeclaration;

template <auto member>
auto& flight(SceneFile& file, std::size_t) {
  return file.flight.*member;
}
template <auto member>
auto& declare(SceneFile& file, std::size_t) {
  return file.declare.*member;
}

void add_hover_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::hover;
  keys.push_back(scene_number("hover.x_rms_mm", "mm", of<s, &H::x_rms_mm>, {0.0, 1e5}, "drift to the side"));
  keys.push_back(scene_number("hover.y_rms_mm", "mm", of<s, &H::y_rms_mm>, {0.0, 1e5}, "drift up and down"));
  keys.push_back(scene_number("hover.z_rms_mm", "mm", of<s, &H::z_rms_mm>, {0.0, 1e5}, "drift to and fro"));
  keys.push_back(scene_number("hover.pitch_rms_deg", "degrees", of<s, &H::pitch_rms_rad>, {0.0, 5.7, kDegPerRad},
                              "rotation about the horizontal axis"));
  keys.push_back(scene_number("hover.yaw_rms_deg", "degrees", of<s, &H::yaw_rms_rad>, {0.0, 5.7, kDegPerRad},
                              "rotation about the vertical axis"));
  keys.push_back(scene_number("hover.roll_rms_deg", "degrees", of<s, &H::roll_rms_rad>, {0.0, 5.7, kDegPerRad},
                              "rotation about the line of sight"));
  keys.push_back(
      scene_number("hover.zoom_rms", "", of<s, &H::zoom_rms>, {0.0, 0.05}, "breathing of the focal length, relative"));
  keys.push_back(scene_number("hover.corner_hz", "Hz", of<s, &H::corner_hz>, {0.001, 100.0},
                              "density 1 / (1 + (f / corner)^order)"));
  keys.push_back(scene_number("hover.order", "", of<s, &H::order>, {2.0, 24.0}, "how steeply the drift falls off"));
  keys.push_back(scene_number("hover.limit_hz", "Hz", of<s, &H::limit_hz>, {0.001, 100.0}, "no drift above it"));
}

void add_flight_keys(std::vector<SceneKey>& keys) {
  keys.push_back(
      scene_path("flight.file", flight<&F::file>,
                 "positions of a recorded flight (CSV), beside the hover model; relative to the scene file"));
  keys.push_back(scene_path("flight.imu", flight<&F::imu>, "its inertial measurements (CSV)"));
  keys.push_back(scene_number("flight.from_s", "s", flight<&F::from_s>, {0.0, 1e6}, "start of the part that is used"));
  keys.push_back(scene_number("flight.to_s", "s", flight<&F::to_s>, {0.0, 1e6}, "its end"));
  keys.push_back(scene_number("flight.imu_starts_at_s", "s", flight<&F::imu_starts_at_s>, {0.0, 1e6},
                              "time in the flight of the first inertial row"));
  keys.push_back(scene_number("flight.imu_from_s", "s", flight<&F::imu_from_s>, {0.0, 1e6},
                              "attitude from another time of the flight; 0 = the same time"));
  keys.push_back(scene_number("flight.scale", "", flight<&F::scale>, {0.0, 100.0}, "the motion times this"));
  keys.push_back(scene_number("flight.facing_deg", "degrees", flight<&F::facing_deg>, {-360.0, 360.0},
                              "where the camera looks, clockwise from north"));
  keys.push_back(scene_number("flight.gimbal_residual", "", flight<&F::gimbal_residual>, {0.0, 1.0},
                              "share of the aircraft's turning that reaches the picture"));
  keys.push_back(scene_number("flight.vibration_from_hz", "Hz", flight<&F::vibration_from_hz>, {0.0, 1e3},
                              "accelerations shake the camera from this frequency on; 0 = not"));
}

void add_rotor_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::rotor;
  keys.push_back(scene_number("rotor.frequency_hz", "Hz", of<s, &R::frequency_hz>, {1.0, 1e3}, "mean rate"));
  keys.push_back(scene_number("rotor.wander_rms_hz", "Hz", of<s, &R::wander_rms_hz>, {0.0, 50.0}, "of that rate"));
  keys.push_back(scene_number("rotor.wander_corner_hz", "Hz", of<s, &R::wander_corner_hz>, {0.001, 10.0},
                              "how quickly it wanders"));
  const std::pair<const char*, SceneField<double>> angles[] = {{"rotor.pitch_rms_mdeg", of<s, &R::pitch_rms_rad>},
                                                               {"rotor.yaw_rms_mdeg", of<s, &R::yaw_rms_rad>},
                                                               {"rotor.roll_rms_mdeg", of<s, &R::roll_rms_rad>}};
  for (const auto& [name, field] : angles) {
    keys.push_back(
        scene_number(name, "1/1000 degree", field, {0.0, 570.0, 1e3 * kDegPerRad}, "vibration of the camera"));
  }
}

void add_timing_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::timing;
  keys.push_back(scene_number("timing.jitter_rms_ms", "ms", of<s, &Ti::jitter_rms_s>, {0.0, 200.0, 1e3},
                              "of the frames' times; at most 0.2 frames"));
  keys.push_back(
      scene_number("timing.drop_probability", "", of<s, &Ti::drop_probability>, {0.0, 0.5}, "a frame is lost"));
  keys.push_back(scene_number("timing.duplicate_probability", "", of<s, &Ti::duplicate_probability>, {0.0, 0.5},
                              "a frame shows the picture before it"));
}

void add_change_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::change;
  keys.push_back(scene_number("change.frequency_drift", "", of<s, &Chg::frequency_drift>, {-0.5, 0.5},
                              "of all frequencies over the clip, relative"));
  keys.push_back(scene_number("change.softening", "", of<s, &Chg::softening>, {-0.15, 0.15},
                              "share of stiffness lost at an amplitude of 1.41 times the last body's rms"));
}

void add_light_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::light;
  keys.push_back(scene_number("light.gain_rms", "", of<s, &L::gain_rms>, {0.0, 0.3},
                              "slow changes of brightness (clouds, exposure), relative"));
  keys.push_back(scene_number("light.gain_corner_hz", "Hz", of<s, &L::gain_corner_hz>, {0.001, 10.0}, "how slow"));
  keys.push_back(scene_number("light.flicker_depth", "", of<s, &L::flicker_depth>, {0.0, 0.9}, "of lamps, relative"));
  keys.push_back(scene_number("light.flicker_hz", "Hz", of<s, &L::flicker_hz>, {0.1, 1e4}, "of lamps"));
  keys.push_back(scene_number("light.flicker_wander_hz", "Hz", of<s, &L::flicker_wander_hz>, {0.0, 1.0},
                              "of lamps: rms of its change, in tens of seconds"));
}

void add_measurement_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::tracks;
  keys.push_back(
      scene_whole("tracks.points_per_region", "", of<s, &T::points_per_region>, {1, 10000}, "in tracks.csv"));
  keys.push_back(scene_number("tracks.noise_px", "px", of<s, &T::noise_px>, {0.0, 100.0},
                              "per axis, independent between points and frames"));
  keys.push_back(scene_number("tracks.noise_spread", "", of<s, &T::noise_spread>, {0.0, 2.0},
                              "points differ: standard deviation of the noise's logarithm"));
  keys.push_back(scene_number("tracks.sigma_error", "", of<s, &T::sigma_error>, {0.0, 2.0},
                              "of the stated sigma: standard deviation of the logarithm of stated / true"));
  keys.push_back(
      scene_number("tracks.loss_probability", "", of<s, &T::loss_probability>, {0.0, 1.0}, "of a point in a frame"));
  keys.push_back(scene_number("tracks.pixel_locking_px", "px", of<s, &T::pixel_locking_px>, {0.0, 1.0},
                              "amplitude of an error periodic in the sub-pixel position"));
  keys.push_back(scene_number("tracks.template_zoom_px", "px", of<s, &T::template_zoom_px>, {0.0, 100.0},
                              "error per unit of magnification since the first frame"));
  keys.push_back(scene_number("tracks.brightness_bias_px", "px", of<s, &T::brightness_bias_px>, {0.0, 100.0},
                              "error per unit of relative brightness change"));
  constexpr auto c = &Scene::channels;
  keys.push_back(scene_number("channels.noise_mm", "mm", of<c, &Ch::noise_mm>, {0.0, 1e4},
                              "of a displacement in displacements.csv"));
  keys.push_back(
      scene_number("channels.loss_probability", "", of<c, &Ch::loss_probability>, {0.0, 1.0}, "of a displacement"));
}

void add_declare_keys(std::vector<SceneKey>& keys) {
  keys.push_back(scene_declared("declare.readout_ms", "ms", declare<&D::readout_ms>, {-1000.0, 1000.0},
                                "what config.yaml says of it: true = the truth, false = nothing, or a wrong value"));
  keys.push_back(scene_declared("declare.exposure_ms", "ms", declare<&D::exposure_ms>, {0.0, 1000.0}, "likewise"));
  keys.push_back(scene_declared("declare.rate_hz", "Hz", declare<&D::rate_hz>, {1.0, 1e4}, "likewise"));
  keys.push_back(scene_switch("declare.lens", declare<&D::lens>, "config.yaml declares the lens; equidistant never"));
  keys.push_back(scene_switch("declare.focal_length", declare<&D::focal_length>,
                              "config.yaml declares focal length and principal point"));
  keys.push_back(scene_switch("declare.timestamps", of<&Scene::timing, &Ti::stamps_tell>,
                              "stamps tell the true times and gaps; false: frame number / rate"));
}

}  // namespace

void add_motion_keys(std::vector<SceneKey>& keys) {
  add_hover_keys(keys);
  add_flight_keys(keys);
  add_rotor_keys(keys);
}

void add_record_keys(std::vector<SceneKey>& keys) {
  add_timing_keys(keys);
  add_change_keys(keys);
  add_light_keys(keys);
  add_measurement_keys(keys);
  add_declare_keys(keys);
}

}  // namespace drivers
