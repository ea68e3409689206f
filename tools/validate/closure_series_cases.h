#pragma once

#include <cstdint>
#include <vector>

#include "core/closure/response/channel_predictor.h"
#include "core/simulation/scene.h"

namespace tools {

// A series as a recorder leaves it that counts what it gets: nothing tells of a lost or late frame.
struct CountedSeries {
  core::closure::ChannelRecord record;
  int n_lost = 0, n_twice = 0;  // frames that are not there, and pictures that came again
  double jitter_rms_ms = 0.0;   // of the frames' times about an even grid
};
[[nodiscard]] CountedSeries counted_series(const core::simulation::Scene& scene);

// Channels of the seed's camera and structure (drawn_scene.h), 120 s, without time stamps.
[[nodiscard]] core::simulation::Scene series_scene(std::uint64_t seed, bool wind);

// An effect in a series; signs are drawn from the scene's seed.
struct SeriesCase {
  const char* effect;  // as closing the loop calls it
  const char* strength;
  void (*apply)(core::simulation::Scene&);
  double (*truth)(const core::simulation::Scene&, const CountedSeries&);  // of its number
};
[[nodiscard]] const std::vector<SeriesCase>& series_cases();

}  // namespace tools
