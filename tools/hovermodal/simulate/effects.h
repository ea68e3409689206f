#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "core/simulation/track_generator.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// Root mean square, per image axis, of the tracks with the effect minus those without it, over the same points of the
// structure and frames that both deliver under the same number: at most 200 frames, of at most two minutes of the
// scene. Empty: the effect does not move tracks (losses, grey levels, channels), or there is no scene without it.
[[nodiscard]] std::optional<double> effect_rms_px(const core::simulation::TrackGenerator& with,
                                                  const std::string& effect);
// The scene cut to two minutes and a few points per region: enough for that.
[[nodiscard]] core::simulation::Scene scene_for_rms(const core::simulation::Scene& scene);

// {name, declared, rms_px, parameters} of each active effect. `scene`: as scene_json() gives it.
[[nodiscard]] nlohmann::ordered_json effects_json(const SimulateJob& job, const nlohmann::ordered_json& scene);

}  // namespace tools
