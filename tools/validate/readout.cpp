// The readout time estimated from tracks, compared with that of the simulated sensor.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/readout_estimator.h"
#include "core/simulation/presets.h"
#include "core/simulation/track_generator.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/geometry.h"
#include "tools/validate/identification_match.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

constexpr std::array kReadouts{-1.0, -0.7, -0.3, 0.0, 0.3, 0.5, 0.7, 1.0};
constexpr std::array kDurations_s{120.0, 300.0};

core::simulation::Scene scene_of(double readout_frames, std::uint64_t seed, double duration_s, bool is_drawn) {
  core::simulation::Scene scene =
      is_drawn ? draw_scene(seed, duration_s).scene : core::simulation::make_paper_scene(seed, duration_s);
  scene.camera.readout_s = std::abs(readout_frames) / scene.camera.rate_hz;
  // Upward readout is downward readout in negative time.
  if (readout_frames < 0.0) scene.camera.readout_direction = core::ReadoutDirection::kUp;
  return scene;
}

// The estimates for every duration.
std::vector<core::ReadoutEstimate> estimate(double readout_frames, std::uint64_t seed, bool is_drawn) {
  const core::simulation::TrackGenerator generator(scene_of(readout_frames, seed, kDurations_s.back(), is_drawn));
  const core::simulation::Scene& scene = generator.motion().scene();
  core::ReadoutEstimator::Config config;
  config.rate_hz = scene.camera.rate_hz;
  config.shear.n_regions = generator.regions().size();
  config.shear.readout = {0.0, core::ReadoutDirection::kDown, scene.camera.width_px, scene.camera.height_px};
  core::simulation::FrameTiming timing = generator.timing();
  core::simulation::DeliveredFrame frame;
  core::TrackFrame tracks;
  std::vector<core::ReadoutEstimate> estimates;
  std::optional<core::ReadoutEstimator> estimator;
  while (timing.next(frame)) {
    generator.generate(frame, tracks);
    if (!estimator) estimator.emplace(config, tracks);
    while (estimates.size() < kDurations_s.size() && frame.t_s >= kDurations_s[estimates.size()])
      estimates.push_back(estimator->estimate());
    estimator->update(tracks);
  }
  while (estimates.size() < kDurations_s.size()) estimates.push_back(estimator->estimate());
  return estimates;
}

}  // namespace

void print_readout(const GeometryOptions& options) {
  fmt::print(
      "# readout: true, frames; seconds; records, with an estimate in; error: mean, standard deviation, worst; stated "
      "standard\n"
      "#   deviation: median; worst error in stated deviations; share within two; bands left out, of\n");
  for (const double readout : kReadouts) {
    const auto records =
        for_each_seed(options, [&](std::uint64_t seed) { return estimate(readout, seed, options.is_drawn); });
    for (std::size_t d = 0; d < kDurations_s.size(); ++d) {
      std::vector<double> error, stated;
      double worst_sigmas = 0.0, against = 0.0, bands = 0.0;
      int n_within = 0;
      for (const auto& record : records) {
        const core::ReadoutEstimate& e = record[d];
        if (!e.observable) continue;
        error.push_back(e.frames - readout);
        stated.push_back(e.std_frames);
        const double sigmas = std::abs(error.back()) / e.std_frames;
        worst_sigmas = std::max(worst_sigmas, sigmas);
        n_within += sigmas <= 2.0 ? 1 : 0;
        against += e.n_bands_against;
        bands += e.n_bands;
      }
      const Statistics e = statistics(error), s = statistics(stated);
      fmt::print(
          "readout{}\t{:+.2f}\t{:.0f}\t{}\t{}\t{:+.5f}\t{:.5f}\t{:.5f}\t{:.5f}\t{:.2f}\t{:.3f}\t{:.1f}\t{:.1f}\n",
          options.is_drawn ? "-drawn" : "", readout, kDurations_s[d], records.size(), e.n, e.mean,
          std::sqrt(std::max(0.0, e.rms * e.rms - e.mean * e.mean)), std::abs(e.worst), s.median, worst_sigmas,
          n_within / std::max(1.0, static_cast<double>(e.n)), against / static_cast<double>(records.size()),
          bands / static_cast<double>(records.size()));
    }
  }
}

}  // namespace tools
