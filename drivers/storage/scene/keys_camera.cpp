#include "drivers/storage/scene/key.h"

#include "core/types/constants.h"

namespace drivers {
namespace {

using core::kDegPerRad;
using core::simulation::Scene;
using C = core::simulation::CameraParameters;
using Lens = core::simulation::LensParameters;

template <auto member>
auto& camera(SceneFile& file, std::size_t) {
  return file.scene.camera.*member;
}

SceneField<double> lens_k(std::size_t k) {
  return [k](SceneFile& file, std::size_t) -> double& { return file.scene.camera.lens.k[k]; };
}

SceneKey preset_key() {
  std::vector<std::pair<std::string, std::string>> choices;
  for (const std::string& name : scene_presets()) choices.emplace_back(name, name);
  return scene_choice<std::string>(
      "preset", [](SceneFile& file, std::size_t) -> std::string& { return file.preset; }, choices,
      "the scene to start from; every other key changes one thing of it");
}

void add_lens_keys(std::vector<SceneKey>& keys) {
  keys.push_back(scene_choice<Lens::Model>(
      "camera.lens.model", [](SceneFile& file, std::size_t) -> Lens::Model& { return file.scene.camera.lens.model; },
      {{"none", Lens::Model::kNone},
       {"radial_tangential", Lens::Model::kRadialTangential},
       {"equidistant", Lens::Model::kEquidistant}},
      "how the lens bends rays; equidistant is a fisheye"));
  keys.push_back(scene_tuple("camera.lens.k", "", {lens_k(0), lens_k(1), lens_k(2), lens_k(3), lens_k(4)}, 4,
                             {-10.0, 10.0}, "radial_tangential: k1 k2 p1 p2 k3; equidistant: k1 k2 k3 k4"));
}

void add_sensor_keys(std::vector<SceneKey>& keys) {
  using core::ReadoutDirection;
  keys.push_back(scene_number("camera.rate_hz", "Hz", camera<&C::rate_hz>, {1.0, 1e4}, "frames per second"));
  keys.push_back(scene_number("camera.readout_ms", "ms", camera<&C::readout_s>, {0.0, 1000.0, 1e3},
                              "rolling shutter: first to last line; 0 = global shutter; at most one frame"));
  keys.push_back(scene_choice<ReadoutDirection>("camera.readout_direction", camera<&C::readout_direction>,
                                                {{"down", ReadoutDirection::kDown},
                                                 {"up", ReadoutDirection::kUp},
                                                 {"left", ReadoutDirection::kLeft},
                                                 {"right", ReadoutDirection::kRight}},
                                                "the way the lines are read"));
  keys.push_back(scene_number("camera.exposure_ms", "ms", camera<&C::exposure_s>, {0.0, 1000.0, 1e3},
                              "of each line; at most one frame"));
  keys.push_back(scene_number("camera.noise_sigma", "grey levels", camera<&C::noise_sigma>, {0.0, 100.0},
                              "of the sensor, white, before rounding to 8 bits; in clips"));
}

}  // namespace

void add_camera_keys(std::vector<SceneKey>& keys) {
  keys.push_back(scene_seed(
      "seed", [](SceneFile& file, std::size_t) -> std::uint64_t& { return file.scene.seed; },
      "everything random follows from it"));
  keys.push_back(scene_number(
      "duration_s", "s", [](SceneFile& file, std::size_t) -> double& { return file.scene.duration_s; }, {1e-3, 21600.0},
      "length of the record"));
  keys.push_back(preset_key());
  keys.push_back(
      scene_whole("camera.width_px", "px", camera<&C::width_px>, {160, 8192}, "of the image; even for a clip"));
  keys.push_back(scene_whole("camera.height_px", "px", camera<&C::height_px>, {160, 8192}, "of the image"));
  keys.push_back(
      scene_number("camera.alpha_px", "px", camera<&C::alpha_px>, {10.0, 1e5}, "focal length; square pixels"));
  keys.push_back(scene_tuple("camera.centre_px", "px", {camera<&C::cx_px>, camera<&C::cy_px>}, 2, {0.0, 8192.0},
                             "principal point [u, v]; pixel centres lie at whole numbers"));
  add_lens_keys(keys);
  add_sensor_keys(keys);
  keys.push_back(scene_tuple("camera.position_mm", "mm", {camera<&C::x_mm>, camera<&C::y_mm>, camera<&C::z_mm>}, 3,
                             {-1e7, 1e7}, "mean position [right, down, ahead]"));
  keys.push_back(scene_tuple(
      "camera.attitude_deg", "degrees", {camera<&C::pitch_rad>, camera<&C::yaw_rad>, camera<&C::roll_rad>}, 3,
      {-180.0, 180.0, kDegPerRad}, "mean attitude [pitch, yaw, roll], in this order; 0 = straight ahead"));
}

}  // namespace drivers
