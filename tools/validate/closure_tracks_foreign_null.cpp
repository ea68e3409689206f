// Records that are foreign to the model, without an effect.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_run.h"
#include "tools/validate/foreign_scene.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

void print_null(const ForeignScene& foreign, std::uint64_t seed, const TracksOutcome& o) {
  const LargestRefused largest = largest_refused(o);
  const double nan = std::nan("");
  fmt::print("closure-tracks-foreign-null\t{}\t{}\t{}\t{}\t{}\t{:.3f}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{:.5f}\t{}\t{:.5f}",
             seed, foreign.hover, foreign.shaken, foreign.background ? "yes" : "no", foreign.n_folded,
             foreign.scene.camera.readout_s * foreign.scene.camera.rate_hz, o.names(), o.result.baseline_rms,
             o.heldout_after(), o.result.noise_floor, largest.named, largest.name, largest.latent);
  fmt::print("\t{:.4f}\t{:.4f}\t{}\t{}\t{}\t{:.1f}\n", o.result.reference_error_before.value_or(nan),
             o.result.reference_error_after.value_or(nan), o.parameters(), o.words, foreign.words, o.seconds);
}

}  // namespace

void print_closure_tracks_foreign_null(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-tracks-foreign-null: seed, hover, shaken by, background, modes that fold, readout (frames), adopted, "
      "held-out before, after, floor (px), largest share of a refused named effect, its name, share of the latent one, "
      "modal error before, after (% rms), parameters, words of the latent ones, the record, seconds\n");
  if (options.flight.empty()) fmt::print("# no recorded flight given: all hover has tails\n");
  const double duration_s = setup_for(options).duration_s;
  const auto records = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
    const std::uint64_t seed = seed_of(options, index);
    ForeignScene foreign = draw_foreign_scene(seed, duration_s, options.flight);
    TracksOutcome outcome = close_tracks_record(foreign_record(foreign.scene, foreign), foreign.scene, seed);
    return std::pair{std::move(foreign), std::move(outcome)};
  });
  int n_false = 0;
  std::map<std::string, int> times, of_hover;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const auto& [foreign, outcome] = records[i];
    print_null(foreign, seed_of(options, i + 1), outcome);
    if (outcome.result.steps.empty()) continue;
    ++n_false, ++of_hover[foreign.hover + (foreign.n_folded > 0 ? ", folded" : "")];
    for (const auto& step : outcome.result.steps)
      ++times[step.kind == core::closure::EffectKind::kLatent ? "latent" : step.effect];
  }
  for (const auto& [name, n] : times) fmt::print("closure-tracks-foreign-adopted\t{}\t{}\n", name, n);
  for (const auto& [kind, n] : of_hover) fmt::print("closure-tracks-foreign-false-of\t{}\t{}\n", kind, n);
  fmt::print("closure-tracks-foreign-false\t{}\t{}\n", n_false, records.size());
}

}  // namespace tools
