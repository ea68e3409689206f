#include "tools/hovermodal/selftest/closure_tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "core/closure/closure_loop.h"
#include "core/closure/observation/observation_level.h"
#include "tools/hovermodal/selftest/closure_tracks_record.h"
#include "tools/hovermodal/selftest/identification_parallel.h"

namespace tools {
namespace {

using core::closure::ClosureResult;
constexpr std::size_t kSurrogates = 12;  // read by a Gumbel distribution
constexpr double kStrengths[] = {0.2, 1.0, 5.0};

struct Outcome {
  ClosureResult result;
  std::string words;  // of the latent ones
  double seconds = 0.0, floor = 0.0, truth = 0.0;
};

Outcome close(const core::closure::ObservationRecord& record, std::uint64_t seed, const std::string& without = {}) {
  const auto start = std::chrono::steady_clock::now();
  core::closure::ObservationLevel level(record);
  if (!without.empty()) level.forget(without);
  core::closure::ClosureOptions options;
  options.n_surrogates = kSurrogates;
  options.seed = seed;
  Outcome out;
  out.result = close_loop(level, options);
  out.floor = out.result.noise_floor;
  for (std::size_t i = 0; i < out.result.steps.size(); ++i) {
    if (const std::string words = level.meaning(i); !words.empty()) out.words += "{" + words + "}";
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

std::uint64_t seed_of(const ClosureTracksOptions& options, std::uint64_t index) {
  return index + static_cast<std::uint64_t>(options.first_seed) - 1;
}

// The last round's candidates: share of the noise, why not.
std::string refused(const ClosureResult& result, double n_values) {
  std::string text;
  for (const auto& step : result.steps) {
    text += fmt::format("{} {:.4f} before ", step.effect, step.score / n_values);
    for (const auto& s : step.others) text += fmt::format("[{} {:.4f} {}]", s.effect, s.score / n_values, s.refusal);
    text += "; ";
  }
  for (const auto& s : result.refused) text += fmt::format("[{} {:.4f} {}]", s.effect, s.score / n_values, s.refusal);
  return text;
}

std::string names(const ClosureResult& result) {
  std::string text;
  for (const auto& step : result.steps) text += (text.empty() ? "" : " + ") + step.effect;
  return text.empty() ? "nothing" : text;
}

std::string parameters(const ClosureResult& result) {
  std::string text;
  for (const auto& step : result.steps) {
    for (const auto& p : step.parameters)
      text += fmt::format("{}{} {:.6g} ({:.2g}) {}", text.empty() ? "" : "; ", p.name, p.value, p.sigma.value_or(0.0),
                          p.unit);
  }
  return text;
}

double error_in_sigma(const Outcome& outcome, const std::string& effect) {
  for (const auto& step : outcome.result.steps) {
    if (step.effect == effect && !step.parameters.empty() && step.parameters[0].sigma &&
        *step.parameters[0].sigma > 0.0)
      return (step.parameters[0].value - outcome.truth) / *step.parameters[0].sigma;
  }
  return std::nan("");
}

}  // namespace

void print_closure_tracks(const ClosureTracksOptions& options) {
  RecordSetup setup;
  if (options.duration_s > 0.0) setup.duration_s = options.duration_s;
  setup.readout_frames = 0.65;
  fmt::print("# bars on the share of the noise: full band {}, low band {}, constants and lines {}\n",
             core::closure::ObservationLevel::kFullBandBar, core::closure::ObservationLevel::kLowBandBar,
             core::closure::ObservationLevel::kGlobalBar);
  fmt::print(
      "# closure: effect, wanted strength, strength, plain strength, size, seed, named, held-out before, after, "
      "floor (px), error of the first parameter in its sigma, parameters, seconds\n"
      "# strength: rms of what the free motions cannot hold / rms of the noise; plain: of the whole change\n");
  for (const HiddenEffect& effect : hidden_effects()) {
    if (!options.effect.empty() && options.effect != effect.name) continue;
    if (effect.name == "readout time")
      setup.readout_frames = 0.0;
    else
      setup.readout_frames = 0.65;
    for (const double strength : kStrengths) {
      if (options.strength > 0.0 && options.strength != strength) continue;
      const EffectSize size = size_for(effect, setup, strength);
      const auto outcomes = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
        const std::uint64_t seed = seed_of(options, index);
        const core::simulation::Scene declared = closure_scene(setup, seed);
        core::simulation::Scene scene = declared;
        effect.set(scene, size.size);
        Outcome out = close(observation_record(scene, declared, setup.background), seed);
        out.truth = effect.truth(scene, size.size);
        return out;
      });
      int n_right = 0;
      for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const Outcome& o = outcomes[i];
        n_right += names(o.result) == effect.name ? 1 : 0;
        const double after = o.result.steps.empty() ? o.result.baseline_rms : o.result.steps.back().heldout_after;
        fmt::print("closure\t{}\t{}\t{:.2f}\t{:.2f}\t{:.5g}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{:+.2f}\t{}\t{}\t{:.1f}\n",
                   effect.name, strength, size.strength, size.plain_strength, size.size, seed_of(options, i + 1), names(o.result),
                   o.result.baseline_rms, after, o.floor, error_in_sigma(o, effect.name), parameters(o.result),
                   o.words + refused(o.result, 480000.0), o.seconds);
      }
      fmt::print("closure-named\t{}\t{}\t{} of {}\n", effect.name, strength, n_right, options.n_seeds);
      std::fflush(stdout);
    }
  }
}

void print_closure_tracks_null(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-null: shaking, background, readout (frames), seed, adopted, largest share of a refused named "
      "effect, its name, share of the latent one, held-out, floor (px), seconds\n");
  int n_false = 0, n = 0;
  for (const Shaking shaking : {Shaking::kGround, Shaking::kWind}) {
    for (const bool background : {true, false}) {
      for (const double readout : {0.0, 0.7, 1.0}) {
        RecordSetup setup{shaking, background, readout, options.duration_s > 0.0 ? options.duration_s : 120.0};
        const auto outcomes = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
        const std::uint64_t seed = seed_of(options, index);
          const core::simulation::Scene scene = closure_scene(setup, seed);
          return close(observation_record(scene, scene, background), seed);
        });
        for (std::size_t i = 0; i < outcomes.size(); ++i) {
          const Outcome& o = outcomes[i];
          const double values = 2.0 * (background ? 80.0 : 70.0) * 25.0 * setup.duration_s;
          double named = -1e9, latent = 0.0;
          std::string which;
          for (const auto& s : o.result.refused) {
            if (s.kind == core::closure::EffectKind::kLatent)
              latent = s.score / values;
            else if (s.score / values > named)
              named = s.score / values, which = s.effect;
          }
          n_false += o.result.steps.empty() ? 0 : 1;
          ++n;
          fmt::print("closure-null\t{}\t{}\t{}\t{}\t{}\t{:.5f}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{:.1f}\n",
                     shaking == Shaking::kGround ? "ground" : "wind", background ? "yes" : "no", readout, i + 1,
                     names(o.result), named, which, latent, o.result.baseline_rms, o.floor, o.seconds);
        }
        std::fflush(stdout);
      }
    }
  }
  fmt::print("closure-false\t{} of {}\n", n_false, n);
}

void print_closure_tracks_outside(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-outside: effect taken out of the catalogue, strength, seed, adopted, held-out before, after, "
      "floor (px), words\n");
  for (const HiddenEffect& effect : hidden_effects()) {
    if (!options.effect.empty() && options.effect != effect.name) continue;
    RecordSetup setup;
    setup.readout_frames = effect.name == "readout time" ? 0.0 : 0.65;
    if (options.duration_s > 0.0) setup.duration_s = options.duration_s;
    const EffectSize size = size_for(effect, setup, 1.0);
    const auto outcomes = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
        const std::uint64_t seed = seed_of(options, index);
      const core::simulation::Scene declared = closure_scene(setup, seed);
      core::simulation::Scene scene = declared;
      effect.set(scene, size.size);
      return close(observation_record(scene, declared, setup.background), seed, effect.name);
    });
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      const ClosureResult& r = outcomes[i].result;
      fmt::print("closure-outside\t{}\t{:.2f}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{}\n", effect.name, size.strength, seed_of(options, i + 1),
                 names(r), r.baseline_rms, r.steps.empty() ? r.baseline_rms : r.steps.back().heldout_after,
                 r.noise_floor, r.unexplained);
    }
    std::fflush(stdout);
  }
}

}  // namespace tools
