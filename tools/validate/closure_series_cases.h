#pragma once

#include <cstdint>
#include <vector>

#include "core/closure/response/channel_predictor.h"
#include "core/simulation/scene.h"

namespace tools {

// A series by a recorder that only counts frames: nothing shows lost or late frames.
struct CountedSeries {
  core::closure::ChannelRecord record;
  int n_lost = 0, n_twice = 0;  // missing frames, and repeated pictures
  double jitter_rms_ms = 0.0;   // of the frames' times about an even grid
};
[[nodiscard]] CountedSeries counted_series(const core::simulation::Scene& scene);

// Channels of the seed's camera and structure (drawn_scene.h), 120 s, without time stamps.
[[nodiscard]] core::simulation::Scene series_scene(std::uint64_t seed, bool wind);

// An effect in a series; signs are drawn from the scene's seed.
struct SeriesCase {
  const char* effect;  // name in residual diagnosis
  const char* strength;
  void (*apply)(core::simulation::Scene&);
  double (*truth)(const core::simulation::Scene&, const CountedSeries&);  // of its parameter
};
[[nodiscard]] const std::vector<SeriesCase>& series_cases();

}  // namespace tools
