#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/simulation/scene.h"
#include "firmware_app/replay/analysis.h"
#include "firmware_app/replay/response_analysis.h"

namespace tools {

// Displacements as the service measures them from tracks of a drawn scene: camera, structure, noise (drawn_scene.h),
// hover and kind of shaking are those of the seed, row delays those of the readout. Frames are counted, not timed.
[[nodiscard]] core::simulation::Scene tracked_scene(std::uint64_t seed);

// The same without an effect in clock or structure, but with one of the disturbances of real flights, by seed: none,
// gusts that roll the camera, an oblique view, a hover with fast tails, rotors and an uneven tracker, shimmering air.
struct TrackedNull {
  core::simulation::Scene scene;
  const char* words = "";
  double shimmer_px = 0.0;  // rms displacement of each region by the air
};
[[nodiscard]] TrackedNull tracked_null(std::uint64_t seed);

struct TrackedSeries {
  app::ChannelSeries series;
  app::SeriesClock clock;
  int n_lost = 0, n_twice = 0;  // missing frames, and repeated pictures
  double jitter_rms_ms = 0.0;   // of the frames' times about an even grid
};

// An undeclared effect of the simulator, or of the delivery of frames.
struct TrackedCase {
  const char* name;    // of the case
  const char* effect;  // name in residual diagnosis
  const char* strength;
  double size;
  bool must_be_named;  // required by the bar
  void (*apply)(core::simulation::Scene&, double size);
  double (*truth)(const core::simulation::Scene&, const TrackedSeries&);  // of its parameter
  double inserted = 0.0;                                                  // share of frames that are delivered twice
  bool average = false;  // the stated rate is delivered frames / duration
};
[[nodiscard]] const std::vector<TrackedCase>& tracked_cases();

struct Delivery {
  double inserted = 0.0, shimmer_px = 0.0;
  bool average = false;
};
[[nodiscard]] TrackedSeries tracked_series(const core::simulation::Scene& scene, const Delivery& delivery = {});

// Of the true modes below 0.45 of the rate that are in both estimates: rms distance of the poles (frequency and
// damping) and of the frequencies alone, percent of the frequency.
struct PoleErrors {
  int n = 0;
  double pole[2] = {}, frequency[2] = {};  // before, after
};
[[nodiscard]] PoleErrors pole_errors(const app::ChannelSeries& before, const app::ChannelSeries& after,
                                     const core::simulation::Scene& scene);

// Residual diagnosis of such records: with an effect in clock or structure, and without.
struct ClosureTracksOptions;
void print_closure_series_tracked(const ClosureTracksOptions& options);
void print_closure_series_tracked_null(const ClosureTracksOptions& options);

}  // namespace tools
