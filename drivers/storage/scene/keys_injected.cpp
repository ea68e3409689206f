// Effects of real records that are not derived from a model of core/closure (core/simulation/injected).

#include "drivers/storage/scene/key.h"

#include "core/types/constants.h"

namespace drivers {
namespace {

using core::kDegPerRad;
using core::simulation::Scene;
using Tails = core::simulation::TailedHoverParameters;

// The three numbers of an array in a section of the scene.
template <auto section, auto member>
std::vector<SceneField<double>> three() {
  std::vector<SceneField<double>> fields;
  for (std::size_t k = 0; k < 3; ++k)
    fields.push_back([k](SceneFile& file, std::size_t) -> double& { return (file.scene.*section.*member)[k]; });
  return fields;
}

void add_tailed_hover_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::tailed_hover;
  keys.push_back(scene_tuple("tailed_hover.rms_mm", "mm", three<s, &Tails::rms_mm>(), 3, {0.0, 1e5},
                             "hover beside `hover`, its spectrum falling off as a power law: [right, down, ahead]"));
  keys.push_back(scene_tuple("tailed_hover.corner_hz", "Hz", three<s, &Tails::corner_hz>(), 3, {0.001, 50.0},
                             "of each: density 1 / (1 + (f / corner)^order) up to 100 Hz"));
  keys.push_back(
      scene_tuple("tailed_hover.order", "", three<s, &Tails::order>(), 3, {2.0, 24.0}, "how steeply each falls off"));
  keys.push_back(scene_tuple("tailed_hover.rms_deg", "degrees", three<s, &Tails::rms_rad>(), 3, {0.0, 5.7, kDegPerRad},
                             "rotation likewise: [pitch, yaw, roll]"));
  keys.push_back(scene_tuple("tailed_hover.turn_corner_hz", "Hz", three<s, &Tails::turn_corner_hz>(), 3, {0.001, 50.0},
                             "corner of each rotation"));
  keys.push_back(scene_tuple("tailed_hover.turn_order", "", three<s, &Tails::turn_order>(), 3, {2.0, 24.0},
                             "order of each rotation"));
}

using V = core::simulation::VibrationParameters;
using St = core::simulation::StabiliserParameters;
using Br = core::simulation::BreathingParameters;
using Sh = core::simulation::ShimmerParameters;

template <auto section, auto member>
std::vector<SceneField<double>> two() {
  std::vector<SceneField<double>> fields;
  for (std::size_t k = 0; k < 2; ++k)
    fields.push_back([k](SceneFile& file, std::size_t) -> double& { return (file.scene.*section.*member)[k]; });
  return fields;
}

void add_camera_effect_keys(std::vector<SceneKey>& keys) {
  constexpr auto v = &Scene::vibration;
  keys.push_back(scene_number("vibration.centre_hz", "Hz", of<v, &V::centre_hz>, {0.1, 100.0},
                              "vibration of the gimbal: middle of its band"));
  keys.push_back(scene_number("vibration.width_hz", "Hz", of<v, &V::width_hz>, {0.001, 50.0},
                              "density exp(-((f - centre) / width)^2 / 2)"));
  keys.push_back(scene_tuple("vibration.rms_mdeg", "1/1000 degree", three<v, &V::rms_rad>(), 3,
                             {0.0, 570.0, 1e3 * kDegPerRad}, "[pitch, yaw, roll]; half of each is common to all"));
  keys.push_back(scene_tuple("vibration.rms_mm", "mm", three<v, &V::rms_mm>(), 3, {0.0, 100.0},
                             "[right, down, ahead] in the same band"));
  constexpr auto s = &Scene::stabiliser;
  keys.push_back(scene_number("stabiliser.gain", "", of<s, &St::gain>, {0.0, 1.0},
                              "electronic stabilisation: every frame is moved as a whole against the camera's motion; "
                              "tracks only"));
  keys.push_back(
      scene_number("stabiliser.corner_hz", "Hz", of<s, &St::corner_hz>, {0.001, 50.0}, "it acts on motion above"));
  keys.push_back(scene_number("stabiliser.lag_ms", "ms", of<s, &St::lag_s>, {0.0, 1000.0, 1e3}, "it acts later by"));
  constexpr auto b = &Scene::breathing;
  keys.push_back(scene_number("breathing.rms", "", of<b, &Br::rms>, {0.0, 0.05},
                              "focus breathing: the image grows and shrinks, relative; tracks only"));
  keys.push_back(scene_number("breathing.corner_hz", "Hz", of<b, &Br::corner_hz>, {0.001, 10.0},
                              "density 1 / (1 + (f / corner)^4)"));
  keys.push_back(scene_tuple("breathing.centre_px", "px", two<b, &Br::centre_px>(), 2, {-8192.0, 8192.0},
                             "about this place, from the principal point"));
}

void add_air_keys(std::vector<SceneKey>& keys) {
  constexpr auto s = &Scene::shimmer;
  keys.push_back(scene_number("shimmer.rms_px", "px", of<s, &Sh::rms_px>, {0.0, 20.0},
                              "refraction by moving air shifts the image, per axis; tracks only"));
  keys.push_back(scene_number("shimmer.outer_px", "px", of<s, &Sh::outer_px>, {1.0, 1e5},
                              "outer scale of its von Karman spectrum in the image"));
  keys.push_back(scene_number("shimmer.inner_px", "px", of<s, &Sh::inner_px>, {1.0, 1e4}, "inner scale"));
  keys.push_back(
      scene_tuple("shimmer.drift_px_s", "px/s", two<s, &Sh::drift_px_s>(), 2, {-1e4, 1e4}, "velocity over the image"));
  keys.push_back(scene_number("shimmer.boiling_px_s", "px/s", of<s, &Sh::boiling_px_s>, {0.0, 1e4},
                              "spread of that velocity over its waves"));
}

template <auto section>
void add_oscillator(std::vector<SceneKey>& keys, const std::string& name) {
  using O = core::simulation::OscillatorParameters;
  keys.push_back(scene_number(name + ".frequency_hz", "Hz", of<section, &O::frequency_hz>, {0.05, 50.0},
                              "natural frequency of its oscillator"));
  keys.push_back(scene_number(name + ".damping_ratio", "", of<section, &O::damping_ratio>, {1e-4, 1.0}, "its damping"));
}

void add_own_motion_keys(std::vector<SceneKey>& keys) {
  using Flap = core::simulation::FlapParameters;
  constexpr auto f = &Scene::flap;
  keys.push_back(scene_number("flap.rms_mm", "mm", of<f, &Flap::rms_mm>, {0.0, 1e3},
                              "a part of a plate moves by itself along the structure's axis"));
  keys.push_back(scene_whole("flap.body", "", of<f, &Flap::body>, {0, 127}, "whose plate; 0 = the ground"));
  keys.push_back(scene_number("flap.from_share", "", of<f, &Flap::from_share>, {0.0, 1.0},
                              "the part to the right of this share of its width"));
  add_oscillator<f>(keys, "flap");
  keys.push_back(scene_number("rocking.rms_deg", "degrees",
                              of<&Scene::rocking, &core::simulation::RockingParameters::rms_rad>,
                              {0.0, 5.7, kDegPerRad}, "the whole structure turns about the middle of its base"));
  add_oscillator<&Scene::rocking>(keys, "rocking");
  keys.push_back(scene_number(
      "torsion.rms_deg", "degrees", of<&Scene::torsion, &core::simulation::TorsionParameters::rms_rad>,
      {0.0, 5.7, kDegPerRad}, "the last body turns about its upright axis, those below less; tracks only"));
  add_oscillator<&Scene::torsion>(keys, "torsion");
  keys.push_back(scene_number("sway.rms_mm", "mm", of<&Scene::sway, &core::simulation::SwayParameters::rms_mm>,
                              {0.0, 1e4}, "the background moves to the side"));
  add_oscillator<&Scene::sway>(keys, "sway");
}

}  // namespace

void add_injected_keys(std::vector<SceneKey>& keys) {
  add_tailed_hover_keys(keys);
  add_camera_effect_keys(keys);
  add_air_keys(keys);
  add_own_motion_keys(keys);
}

}  // namespace drivers
