#pragma once

#include <string>
#include <vector>

#include "core/simulation/scene.h"

namespace core::simulation {

// Everything in a scene that makes its pictures, tracks or channels differ from those of a still, ideal camera in front
// of a structure under white input. Each can be taken away alone; all that is left stays as it was, draw by draw.
// Tracks show the same points with and without.

[[nodiscard]] std::vector<std::string> effect_names();  // all that are known
[[nodiscard]] std::vector<std::string> active_effects(const Scene& scene);
// Both throw std::invalid_argument for an unknown name. A scene without "mean_attitude" may look elsewhere, and fail
// validate().
[[nodiscard]] Scene without_effect(const Scene& scene, const std::string& name);
// The parameters that describe it, as scene files call them: "camera.readout_ms".
[[nodiscard]] std::vector<std::string> effect_keys(const std::string& name);

}  // namespace core::simulation
