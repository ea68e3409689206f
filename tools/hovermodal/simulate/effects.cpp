#include "tools/hovermodal/simulate/effects.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "core/simulation/effects.h"

namespace tools {
namespace {

using core::simulation::DeliveredFrame;
using core::simulation::Scene;
using core::simulation::TrackGenerator;
using Json = nlohmann::ordered_json;

constexpr double kLongest_s = 120.0;
constexpr std::size_t kMostFrames = 200;
constexpr int kMostPoints = 6;  // per region: sufficient for a sum over all frames
// Rounding of the arithmetic, below the resolution of tracks.csv.
constexpr double kNothing_px = 1e-9;

std::vector<DeliveredFrame> frames_of(const TrackGenerator& generator) {
  std::vector<DeliveredFrame> frames;
  auto timing = generator.timing();
  for (DeliveredFrame frame; timing.next(frame);) frames.push_back(frame);
  return frames;
}

Scene part_of(const Scene& scene) {
  Scene part = scene;
  part.duration_s = std::min(scene.duration_s, kLongest_s);
  part.tracks.points_per_region = std::min(scene.tracks.points_per_region, kMostPoints);
  return part;
}

bool same_point(const TrackGenerator& a, const TrackGenerator& b, std::size_t i) {
  const auto& p = a.points()[i];
  const auto& q = b.points()[i];
  return p.body == q.body && p.point.x_mm == q.point.x_mm && p.point.y_mm == q.point.y_mm;
}

// Sums of squared differences of one frame.
struct Squares {
  double sum = 0.0;
  std::size_t n = 0;
};

void add_frame(const TrackGenerator& with, const core::TrackFrame& seen, const TrackGenerator& without,
               const DeliveredFrame& frame, Squares& squares) {
  core::TrackFrame clean;
  without.generate(frame, clean);
  for (std::size_t i = 0; i < std::min(seen.points.size(), clean.points.size()); ++i) {
    if (!same_point(with, without, i)) continue;
    const double du = seen.points[i].u_px - clean.points[i].u_px, dv = seen.points[i].v_px - clean.points[i].v_px;
    if (!std::isfinite(du) || !std::isfinite(dv)) continue;
    squares.sum += du * du + dv * dv;
    squares.n += 2;
  }
}

double rms_between(const SampledTracks& with, const TrackGenerator& without) {
  const std::vector<DeliveredFrame> frames = frames_of(without);
  Squares squares;
  for (const core::TrackFrame& seen : with.frames) {
    const auto same = std::lower_bound(frames.begin(), frames.end(), seen.sequence,
                                       [](const DeliveredFrame& f, std::uint64_t s) { return f.sequence < s; });
    if (same != frames.end() && same->sequence == seen.sequence) {
      add_frame(with.generator, seen, without, *same, squares);
    }
  }
  return squares.n > 0 ? std::sqrt(squares.sum / static_cast<double>(squares.n)) : 0.0;
}

// The declared part of the effect; the rest has no key in the configuration.
Json declared(const SimulateJob& job, const std::string& effect, const Json& scene) {
  if (effect == "readout") return drivers::scene_value(scene, "declare.readout_ms");
  if (effect == "exposure") return drivers::scene_value(scene, "declare.exposure_ms");
  if (effect == "lens") return job.declares_lens();
  if (effect == "jitter" || effect == "drops") return job.scene().timing.stamps_tell;
  return false;
}

}  // namespace

SampledTracks::SampledTracks(const Scene& scene) : generator(part_of(scene)) {
  const std::vector<DeliveredFrame> all = frames_of(generator);
  const std::size_t step = std::max<std::size_t>(1, all.size() / kMostFrames);
  for (std::size_t i = 0; i < all.size(); i += step) generator.generate(all[i], frames.emplace_back());
}

std::optional<double> effect_rms_px(const SampledTracks& with, const std::string& effect) try {
  const Scene& scene = with.generator.motion().scene();
  const double rms = rms_between(with, TrackGenerator(core::simulation::without_effect(scene, effect)));
  return rms > kNothing_px ? std::optional(rms) : std::nullopt;
} catch (const std::invalid_argument&) {
  return std::nullopt;  // without it the structure is not in view
}

Json effects_json(const SimulateJob& job, const Json& scene) {
  Json effects = Json::array();
  const SampledTracks with(job.scene());
  for (const std::string& name : core::simulation::active_effects(job.scene())) {
    const std::optional<double> rms_px = effect_rms_px(with, name);
    Json parameters = Json::object();
    for (const std::string& key : core::simulation::effect_keys(name)) {
      parameters[key] = drivers::scene_value(scene, key);
    }
    effects.push_back({{"name", name},
                       {"declared", declared(job, name, scene)},
                       {"rms_px", rms_px ? Json(*rms_px) : Json()},
                       {"parameters", std::move(parameters)}});
  }
  return effects;
}

}  // namespace tools
