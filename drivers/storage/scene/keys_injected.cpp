// Effects of real records that no model of core/closure was built from (core/simulation/injected).
#include <numbers>

#include "drivers/storage/scene/key.h"

namespace drivers {
namespace {

using core::simulation::Scene;
using Tails = core::simulation::TailedHoverParameters;
constexpr double kDegrees = 180.0 / std::numbers::pi;

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
  keys.push_back(scene_tuple("tailed_hover.rms_deg", "degrees", three<s, &Tails::rms_rad>(), 3, {0.0, 5.7, kDegrees},
                             "rotation likewise: [pitch, yaw, roll]"));
  keys.push_back(scene_tuple("tailed_hover.turn_corner_hz", "Hz", three<s, &Tails::turn_corner_hz>(), 3, {0.001, 50.0},
                             "corner of each rotation"));
  keys.push_back(scene_tuple("tailed_hover.turn_order", "", three<s, &Tails::turn_order>(), 3, {2.0, 24.0},
                             "order of each rotation"));
}

}  // namespace

void add_injected_keys(std::vector<SceneKey>& keys) { add_tailed_hover_keys(keys); }

}  // namespace drivers
