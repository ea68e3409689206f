#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/simulation/track_generator.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// Tracks of a scene for comparison: at most 200 frames of at most two minutes, a few points per region.
struct SampledTracks {
  explicit SampledTracks(const core::simulation::Scene& scene);

  core::simulation::TrackGenerator generator;
  std::vector<core::TrackFrame> frames;
};

// Root mean square, per image axis, of the tracks with the effect minus those without it, over the same points of the
// structure and over frames that both deliver with the same number. Empty: the effect does not move tracks (losses,
// grey levels, channels), or there is no scene without it.
[[nodiscard]] std::optional<double> effect_rms_px(const SampledTracks& with, const std::string& effect);

// {name, declared, rms_px, parameters} of each active effect. `scene`: as scene_json() gives it.
[[nodiscard]] nlohmann::ordered_json effects_json(const SimulateJob& job, const nlohmann::ordered_json& scene);

}  // namespace tools
