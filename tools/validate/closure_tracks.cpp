#include "tools/validate/closure_tracks.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/closure/observation/kinds/materiality.h"
#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_tracks_run.h"
#include "tools/validate/identification_parallel.h"

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

struct InjectedRecord {
  TracksOutcome outcome;
  EffectStrength strength;
  double size = 0.0;
  ParameterErrors errors;
};

InjectedRecord inject(const HiddenEffect& effect, const RecordSetup& setup, double strength, std::uint64_t seed) {
  const Scene declared = closure_scene(setup, seed);
  const SizedScene sized = with_effects({&effect}, declared, strength, setup.background);
  const auto with = observation_record(sized.scene, declared, setup.background);
  InjectedRecord out;
  out.size = sized.size.front();
  out.strength = strength_of(with, observation_record(declared, declared, setup.background),
                             noise_px(declared, setup.background), true);
  out.outcome = close_tracks_record(with, sized.scene, seed);
  out.errors = parameter_errors(out.outcome.result.steps, effect.called, effect.truth(sized.scene, declared));
  return out;
}

void print_record(const HiddenEffect& effect, double wanted, std::uint64_t seed, const InjectedRecord& record,
                  double twin) {
  const double nan = std::nan("");
  const TracksOutcome& o = record.outcome;
  fmt::print("closure-tracks\t{}\t{}\t{}\t{:.3f}\t{:.3f}\t{:.4f}\t{:.5g}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.5f}", effect.name,
             effect.called, wanted, record.strength.plain, record.strength.constant, record.strength.visible,
             record.size, seed, o.names(), o.result.baseline_rms, o.heldout_after(), o.result.noise_floor);
  fmt::print("\t{:.2f}\t{:.5g}\t{:.3f}\t{:.3f}\t{:.3f}\t{}\t{}{}\t{:.1f}\n", record.errors.worst_sigmas,
             record.errors.first, o.result.reference_error_before.value_or(nan),
             o.result.reference_error_after.value_or(nan), twin, o.parameters(), o.words, o.refused(), o.seconds);
}

std::vector<double> twins_of(const ClosureTracksOptions& options, const RecordSetup& setup) {
  return for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
    const Scene scene = closure_scene(setup, seed_of(options, index));
    return plain_modal_error(observation_record(scene, scene, setup.background), scene);
  });
}

}  // namespace

void print_closure_tracks(const ClosureTracksOptions& options) {
  fmt::print("# bars on the share of the noise: full band {}, lines {}, constants {}\n", core::closure::kFullBandBar,
             core::closure::kLineBar, core::closure::kGlobalBar);
  fmt::print(
      "# closure-tracks: effect, its name in the catalogue, wanted strength, strength, constant part, visible part, "
      "size, seed, named, held-out before, after, floor (px), worst error of its parameters in their sigmas, error of "
      "the first in its unit, modal error before, after, of the record without the effect (% rms), parameters, words, "
      "seconds\n"
      "# strength: rms of the effect in the tracks / rms of their noise; constant: the points' mean places (not in "
      "it); "
      "visible: what the free motions cannot hold\n");
  const RecordSetup setup = setup_for(options);
  const std::vector<double> twins = twins_of(options, setup);
  for (const HiddenEffect& effect : hidden_effects()) {
    if (!options.effect.empty() && options.effect != effect.name) continue;
    for (const double strength : kStrengths) {
      if (options.strength > 0.0 && options.strength != strength) continue;
      const auto records = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
        return inject(effect, setup, strength, seed_of(options, index));
      });
      for (std::size_t i = 0; i < records.size(); ++i)
        print_record(effect, strength, seed_of(options, i + 1), records[i], twins[i]);
      std::fflush(stdout);
    }
  }
}

void print_closure_tracks_pairs(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-tracks-pair: both effects, strength of each, seed, named, held-out before, after, floor (px), worst "
      "errors of their parameters in their sigmas, parameters, words, seconds\n");
  const double strength = options.strength > 0.0 ? options.strength : 1.0;
  const RecordSetup setup = setup_for(options);
  for (const auto& pair : kPairs) {
    const HiddenEffect &a = effect_named(pair[0]), &b = effect_named(pair[1]);
    const std::string name = a.name + " + " + b.name;
    if (!options.effect.empty() && options.effect != name) continue;
    const auto lines = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
      const std::uint64_t seed = seed_of(options, index);
      const Scene declared = closure_scene(setup, seed);
      const Scene scene = with_effects({&a, &b}, declared, strength, setup.background).scene;
      const TracksOutcome o = close_tracks_record(observation_record(scene, declared, setup.background), scene, seed);
      const auto off = [&](const HiddenEffect& e) {
        return parameter_errors(o.result.steps, e.called, e.truth(scene, declared)).worst_sigmas;
      };
      return fmt::format(
          "closure-tracks-pair\t{}\t{}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{:.2f}\t{:.2f}\t{}\t{}{}\t{:.1f}\n", name,
          strength, seed, o.names(), o.result.baseline_rms, o.heldout_after(), o.result.noise_floor, off(a), off(b),
          o.parameters(), o.words, o.refused(), o.seconds);
    });
    for (const std::string& line : lines) fmt::print("{}", line);
    std::fflush(stdout);
  }
}

}  // namespace tools
