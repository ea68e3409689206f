// Closing the loop on series of channels: what it finds where the undeclared effect is known, and where there is none.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/closure/closure_loop.h"
#include "core/closure/response/channel_model.h"
#include "core/closure/response/response_level.h"
#include "core/simulation/channel_generator.h"
#include "core/simulation/presets.h"
#include "tools/hovermodal/selftest/identification.h"
#include "tools/hovermodal/selftest/identification_parallel.h"

namespace tools {
namespace {

using core::closure::ChannelRecord;
using core::simulation::Scene;

constexpr double kDuration_s = 120.0;
constexpr std::size_t kSurrogates = 64, kWhenPlain = 12;

struct Case {
  const char* effect;  // as closing the loop calls it
  const char* strength;
  double truth;  // of its number; NaN = counted in the record
  void (*apply)(Scene&);
};
const Case kCases[] = {
    {"frequency_drift", "4 %", 4.0, [](Scene& s) { s.change.frequency_drift = 0.04; }},
    {"softening", "3 %", -3.0, [](Scene& s) { s.change.softening = 0.03; }},
    {"time_stamp_jitter", "1 ms", 1.0, [](Scene& s) { s.timing.jitter_rms_s = 1e-3; }},
    {"time_stamp_jitter", "4 ms", 4.0, [](Scene& s) { s.timing.jitter_rms_s = 4e-3; }},
    {"dropped_frames", "1 %", std::numeric_limits<double>::quiet_NaN(),
     [](Scene& s) { s.timing.drop_probability = 0.01; }},
    {"duplicated_frames", "1 %", std::numeric_limits<double>::quiet_NaN(),
     [](Scene& s) { s.timing.duplicate_probability = 0.01; }},
};

// As a recorder that counts what it gets: nothing tells of a lost or late frame.
ChannelRecord record_of(const Scene& scene, double& lost) {
  const core::simulation::SceneMotion motion(scene);
  const core::simulation::ChannelGenerator generator(motion, scene.camera.readout_s);
  core::DisplacementSample sample = generator.sample_prototype();
  core::simulation::FrameTiming timing(scene);
  core::simulation::DeliveredFrame frame;
  std::vector<std::vector<double>> rows;
  std::uint64_t last = 0;
  while (timing.next(frame)) {
    generator.generate(frame, sample);
    rows.push_back(sample.value_mm);
    last = frame.number;
  }
  lost = static_cast<double>(last + 1 - rows.size());
  ChannelRecord out;
  out.rate_hz = scene.camera.rate_hz;
  const auto& channels = generator.channels();
  const auto n = static_cast<Eigen::Index>(rows.size());
  const auto n_base = std::count_if(channels.begin(), channels.end(), [](const auto& c) { return c.is_base; });
  out.value.resize(n, static_cast<Eigen::Index>(channels.size()) - n_base);
  out.input.resize(n, n_base);
  for (Eigen::Index k = 0; k < n; ++k) {
    Eigen::Index value = 0, input = 0;
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double v = rows[static_cast<std::size_t>(k)][c];
      (channels[c].is_base ? out.input(k, input++) : out.value(k, value++)) = v;
    }
  }
  return out;
}

Scene scene_of(std::uint64_t seed, bool wind) {
  Scene scene = core::simulation::make_paper_scene(seed, kDuration_s);
  scene.timing.stamps_tell = false;
  if (wind) scene.excitation.base = 0.0, scene.excitation.forces = 1.0;
  return scene;
}

struct Outcome {
  std::vector<std::string> named;
  double value = 0.0, sigma = 0.0, truth = 0.0;  // of the effect that is there
  double before = 0.0, after = 0.0;
};

Outcome close(const Scene& scene, std::uint64_t seed, const std::string& effect) {
  Outcome out;
  const core::closure::ChannelModel model(record_of(scene, out.truth));
  core::closure::ResponseLevel level(model);
  core::closure::ClosureOptions options;
  options.seed = seed;
  options.n_surrogates = kSurrogates;
  options.n_surrogates_when_plain = kWhenPlain;
  const core::closure::ClosureResult result = core::closure::close_loop(level, options);
  out.before = result.reference_error_before.value_or(0.0);
  out.after = result.reference_error_after.value_or(0.0);
  for (const auto& step : result.steps) {
    out.named.push_back(step.effect);
    if (step.effect != effect || step.parameters.empty()) continue;
    out.value = step.parameters.front().value;
    out.sigma = step.parameters.front().sigma.value_or(0.0);
  }
  return out;
}

void print_case(const Case& one, const IdentificationOptions& options) {
  const auto results = for_each_seed(
      options.n_seeds, options.n_threads,
      [&](std::uint64_t seed) {
        Scene scene = scene_of(seed, false);
        one.apply(scene);
        return close(scene, seed, one.effect);
      },
      options.first_seed);
  int alone = 0, beside = 0, wrong = 0, nothing = 0, within = 0;
  double sum = 0.0, before = 0.0, after = 0.0;
  for (const Outcome& result : results) {
    const bool named = std::find(result.named.begin(), result.named.end(), one.effect) != result.named.end();
    if (result.named.empty()) ++nothing;
    if (named) ++(result.named.size() == 1 ? alone : beside), sum += result.value;
    if (!named && !result.named.empty()) ++wrong;
    if (named && result.sigma > 0.0 && std::abs(result.value - one.truth) <= 3.0 * result.sigma) ++within;
    before += result.before / options.n_seeds, after += result.after / options.n_seeds;
  }
  fmt::print("series\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.3g}\t{}\t{:.4f}\t{:.4f}\n", one.effect, one.strength,
             options.n_seeds, alone, beside, wrong, nothing, alone + beside > 0 ? sum / (alone + beside) : std::nan(""),
             within, before, after);
  std::fflush(stdout);
}

}  // namespace

void print_closure_series(const IdentificationOptions& options) {
  fmt::print(
      "# {:g} s of the paper's structure at 25 fps: effect, strength, records; named alone, with another, only "
      "another, "
      "nothing; mean number, within 3 sigma; held-out innovations before, after\n",
      kDuration_s);
  for (const Case& one : kCases) print_case(one, options);
}

void print_closure_series_null(const IdentificationOptions& options) {
  fmt::print("# no effect: input, records, false adoptions, which\n");
  for (const bool wind : {false, true}) {
    const auto results = for_each_seed(
        options.n_seeds, options.n_threads, [&](std::uint64_t seed) { return close(scene_of(seed, wind), seed, ""); },
        options.first_seed);
    int n_false = 0;
    std::string which;
    for (const Outcome& result : results) {
      n_false += result.named.empty() ? 0 : 1;
      for (const std::string& name : result.named) which += (which.empty() ? "" : " ") + name;
    }
    fmt::print("series-null\t{}\t{}\t{}\t{}\n", wind ? "wind" : "shaken", options.n_seeds, n_false, which);
  }
}

}  // namespace tools
