// Records that are foreign to the model, with undeclared effects.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_run.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/foreign_effects.h"
#include "tools/validate/foreign_scene.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::simulation::Scene;
using Effects = std::vector<const ForeignEffect*>;
constexpr std::array kForeignStrengths{0.2, 1.0, 5.0};

struct ForeignOutcome {
  ForeignScene declared;
  Scene scene;
  std::vector<double> size;
  EffectStrength strength;
  TracksOutcome outcome;
  double twin = 0.0;  // modal error of the record without the effects
};

ForeignOutcome inject(const Effects& effects, const ClosureTracksOptions& options, double strength,
                      std::uint64_t seed) {
  ForeignOutcome out;
  out.declared = draw_foreign_scene(seed, setup_for(options).duration_s, options.flight);
  std::vector<const HiddenEffect*> hidden;
  for (const ForeignEffect* effect : effects) {
    hidden.push_back(&effect->effect);
    out.declared.background = out.declared.background || effect->in_background;
  }
  const SizedScene sized = with_effects(hidden, out.declared.scene, strength, out.declared.background);
  out.scene = sized.scene, out.size = sized.size;
  const auto with = foreign_record(out.scene, out.declared);
  const auto without = foreign_record(out.declared.scene, out.declared);
  out.strength = strength_of(with, without, noise_px(out.declared.scene, out.declared.background), true);
  out.outcome = close_tracks_record(with, out.scene, seed);
  out.twin = plain_modal_error(without, out.declared.scene);
  return out;
}

// Errors of all known parameters, in sigmas: "0.31 -1.20"; "-" if there are none.
std::string errors_text(const Effects& effects, const ForeignOutcome& record) {
  std::string text;
  for (const ForeignEffect* effect : effects) {
    const auto truth = effect->effect.truth(record.scene, record.declared.scene);
    for (const double error : errors_in_sigmas(record.outcome.result.steps, *effect, truth))
      text += fmt::format("{}{:.2f}", text.empty() ? "" : " ", error);
  }
  return text.empty() ? "-" : text;
}

std::string sizes_text(const std::vector<double>& sizes) {
  std::string text;
  for (const double size : sizes) text += fmt::format("{}{:.4g}", text.empty() ? "" : " ", size);
  return text;
}

void print_record(const char* check, const std::string& name, const Effects& effects, double wanted, std::uint64_t seed,
                  const ForeignOutcome& record) {
  const TracksOutcome& o = record.outcome;
  const double nan = std::nan("");
  fmt::print("{}\t{}\t{}\t{:.3f}\t{:.3f}\t{:.4f}\t{}\t{}\t{}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{}", check, name, wanted,
             record.strength.plain, record.strength.constant, record.strength.visible, sizes_text(record.size), seed,
             word_for(answer_of(o.result.steps, effects)), o.names(), o.result.baseline_rms, o.heldout_after(),
             o.result.noise_floor, errors_text(effects, record));
  fmt::print("\t{:.4f}\t{:.4f}\t{:.4f}\t{}\t{}{}\t{}\t{:.1f}\n", o.result.reference_error_before.value_or(nan),
             o.result.reference_error_after.value_or(nan), record.twin, o.parameters(), o.words, o.refused(),
             record.declared.words, o.seconds);
}

void print_columns(const char* check) {
  fmt::print(
      "# {}: effect, wanted strength, strength, constant part, visible part, size, seed, answer, adopted, held-out "
      "before, after, floor (px), errors of the known parameters in their sigmas, modal error before, after, of the "
      "record without the effect (% rms), parameters, words, the record, seconds\n",
      check);
}

// Two of them for an odd seed, else three, drawn so that no two share a name.
Effects drawn_set(std::uint64_t seed) {
  const auto& all = foreign_effects();
  Draw draw(seed, "foreign_set");
  Effects set;
  const std::size_t n = seed % 2 == 1 ? 2 : 3;
  while (set.size() < n) {
    const ForeignEffect& next = all[static_cast<std::size_t>(draw.whole(0, static_cast<int>(all.size()) - 1))];
    if (std::none_of(set.begin(), set.end(), [&](const auto* other) { return share_a_name(next, *other); }))
      set.push_back(&next);
  }
  return set;
}

}  // namespace

void print_closure_tracks_foreign(const ClosureTracksOptions& options) {
  print_columns("closure-tracks-foreign");
  for (const ForeignEffect& effect : foreign_effects()) {
    if (!options.effect.empty() && options.effect != effect.effect.name) continue;
    for (const double strength : kForeignStrengths) {
      if (options.strength > 0.0 && options.strength != strength) continue;
      const auto records = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
        return inject({&effect}, options, strength, seed_of(options, index));
      });
      for (std::size_t i = 0; i < records.size(); ++i)
        print_record("closure-tracks-foreign", effect.effect.name, {&effect}, strength, seed_of(options, i + 1),
                     records[i]);
      std::fflush(stdout);
    }
  }
}

void print_closure_tracks_foreign_sets(const ClosureTracksOptions& options) {
  print_columns("closure-tracks-foreign-sets");
  const double strength = options.strength > 0.0 ? options.strength : 1.0;
  const auto records = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
    const std::uint64_t seed = seed_of(options, index);
    return inject(drawn_set(seed), options, strength, seed);
  });
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::uint64_t seed = seed_of(options, i + 1);
    const Effects set = drawn_set(seed);
    std::string name;
    for (const ForeignEffect* effect : set) name += (name.empty() ? "" : " + ") + effect->effect.name;
    print_record("closure-tracks-foreign-sets", name, set, strength, seed, records[i]);
  }
}

}  // namespace tools
