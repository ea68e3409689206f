#include "tools/hovermodal/selftest/closure_tracks.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "core/closure/observation/observation_level.h"
#include "tools/hovermodal/selftest/closure_tracks_run.h"
#include "tools/hovermodal/selftest/identification_parallel.h"

namespace tools {
namespace {

using core::simulation::Scene;
constexpr std::array kStrengths{0.2, 1.0, 5.0};
constexpr std::array<std::array<const char*, 2>, 7> kPairs{{{"camera roll", "readout time"},
                                                            {"camera roll", "radial distortion"},
                                                            {"radial distortion", "readout time"},
                                                            {"camera yaw", "readout time"},
                                                            {"camera pitch", "radial distortion"},
                                                            {"camera roll", "pixel locking"},
                                                            {"camera roll", "rotor line"}}};

double error_of(const TracksOutcome& o, const std::string& effect, bool in_sigma) {
  for (const auto& step : o.result.steps) {
    if (step.effect != effect || step.parameters.empty()) continue;
    const auto& p = step.parameters.front();
    if (!in_sigma) return p.value - o.truth;
    if (p.sigma && *p.sigma > 0.0) return (p.value - o.truth) / *p.sigma;
  }
  return std::nan("");
}

void print_record(const HiddenEffect& effect, const EffectSize& size, double wanted, std::uint64_t seed,
                  const TracksOutcome& o, double twin) {
  const double nan = std::nan("");
  fmt::print("closure-tracks\t{}\t{}\t{:.2f}\t{:.2f}\t{:.5g}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.5f}", effect.name, wanted,
             size.strength, size.plain_strength, size.size, seed, o.names(), o.result.baseline_rms, o.heldout_after(),
             o.result.noise_floor);
  fmt::print("\t{:+.2f}\t{:.5g}\t{:.3f}\t{:.3f}\t{:.3f}\t{}\t{}{}\t{:.1f}\n", error_of(o, effect.name, true),
             error_of(o, effect.name, false), o.result.reference_error_before.value_or(nan),
             o.result.reference_error_after.value_or(nan), twin, o.parameters(), o.words, o.refused(), o.seconds);
}

std::vector<double> twins_of(const ClosureTracksOptions& options, const RecordSetup& setup) {
  return for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
    const Scene scene = closure_scene(setup, seed_of(options, index));
    return plain_modal_error(observation_record(scene, scene, setup.background), scene);
  });
}

const HiddenEffect& effect_named(const std::string& name) {
  for (const HiddenEffect& effect : hidden_effects()) {
    if (effect.name == name) return effect;
  }
  throw std::invalid_argument("no effect " + name);
}

}  // namespace

void print_closure_tracks(const ClosureTracksOptions& options) {
  using Level = core::closure::ObservationLevel;
  fmt::print("# bars on the share of the noise: full band {}, low band {}, constants and lines {}\n",
             Level::kFullBandBar, Level::kLowBandBar, Level::kGlobalBar);
  fmt::print(
      "# closure-tracks: effect, wanted strength, strength, plain strength, size, seed, named, held-out before, after, "
      "floor (px), error of the first parameter in its sigma, in its unit, modal error before, after, of the record "
      "without the effect (% rms), parameters, words, seconds\n"
      "# strength: rms of what the free motions cannot hold / rms of the noise; plain: of the whole change\n");
  std::map<double, std::vector<double>> twins;  // by readout
  for (const HiddenEffect& effect : hidden_effects()) {
    if (!options.effect.empty() && options.effect != effect.name) continue;
    const RecordSetup setup = setup_for(options, effect.name);
    if (!twins.contains(setup.readout_frames)) twins[setup.readout_frames] = twins_of(options, setup);
    for (const double strength : kStrengths) {
      if (options.strength > 0.0 && options.strength != strength) continue;
      const EffectSize size = size_for(effect, setup, strength);
      const auto outcomes = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
        const Scene declared = closure_scene(setup, seed_of(options, index));
        Scene scene = declared;
        effect.set(scene, size.size);
        TracksOutcome out =
            close_tracks_record(observation_record(scene, declared, setup.background), scene, seed_of(options, index));
        out.truth = effect.truth(scene, size.size);
        return out;
      });
      for (std::size_t i = 0; i < outcomes.size(); ++i)
        print_record(effect, size, strength, seed_of(options, i + 1), outcomes[i], twins[setup.readout_frames][i]);
      std::fflush(stdout);
    }
  }
}

void print_closure_tracks_pairs(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-tracks-pair: both effects, strength of each, seed, named, held-out before, after, floor (px), "
      "parameters, words, seconds\n");
  const double strength = options.strength > 0.0 ? options.strength : 1.0;
  for (const auto& pair : kPairs) {
    const HiddenEffect &a = effect_named(pair[0]), &b = effect_named(pair[1]);
    const RecordSetup setup = setup_for(options, b.name);
    const EffectSize size_a = size_for(a, setup, strength), size_b = size_for(b, setup, strength);
    const auto outcomes = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
      const Scene declared = closure_scene(setup, seed_of(options, index));
      Scene scene = declared;
      a.set(scene, size_a.size);
      b.set(scene, size_b.size);
      return close_tracks_record(observation_record(scene, declared, setup.background), scene, seed_of(options, index));
    });
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const TracksOutcome& o = outcomes[i];
      fmt::print("closure-tracks-pair\t{} + {}\t{}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{}\t{}{}\t{:.1f}\n", a.name, b.name,
                 strength, seed_of(options, i + 1), o.names(), o.result.baseline_rms, o.heldout_after(),
                 o.result.noise_floor, o.parameters(), o.words, o.refused(), o.seconds);
    }
    std::fflush(stdout);
  }
}

}  // namespace tools
