#pragma once

#include <string>
#include <vector>

#include "core/simulation/scene.h"

namespace core::simulation {

// Everything in a scene that makes its images, tracks or channels differ from those of a static, ideal camera and a
// structure under white input. Each effect can be removed alone; all others stay unchanged, random draw by random draw.
// Tracks contain the same points with and without it.

[[nodiscard]] std::vector<std::string> effect_names();  // all known effects
[[nodiscard]] std::vector<std::string> active_effects(const Scene& scene);
// Both throw std::invalid_argument for an unknown name. A scene without "mean_attitude" may look elsewhere and fail
// validate().
[[nodiscard]] Scene without_effect(const Scene& scene, const std::string& name);
// Parameters of the effect, as named in scene files: "camera.readout_ms".
[[nodiscard]] std::vector<std::string> effect_keys(const std::string& name);

}  // namespace core::simulation
