// Records without an effect.
#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <vector>

#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_run.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::simulation::Scene;

// Returns the number of records in which an effect was adopted.
int print_nulls(const ClosureTracksOptions& options, const RecordSetup& setup) {
  const auto outcomes = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
    const Scene scene = closure_scene(setup, seed_of(options, index));
    return close_tracks_record(observation_record(scene, scene, setup.background), scene, seed_of(options, index));
  });
  int n_false = 0;
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const TracksOutcome& o = outcomes[i];
    const LargestRefused largest = largest_refused(o);
    n_false += o.result.steps.empty() ? 0 : 1;
    fmt::print("closure-tracks-null\t{}\t{}\t{}\t{}\t{}\t{:.5f}\t{}\t{:.5f}\t{:.5f}\t{:.5f}\t{}\t{:.1f}\n",
               setup.shaking == Shaking::kGround ? "ground" : "wind", setup.background ? "yes" : "no",
               setup.readout_frames.value_or(-1.0), seed_of(options, i + 1), o.names(), largest.named, largest.name,
               largest.latent, o.result.baseline_rms, o.result.noise_floor, o.words, o.seconds);
  }
  std::fflush(stdout);
  return n_false;
}

}  // namespace

void print_closure_tracks_null(const ClosureTracksOptions& options) {
  fmt::print(
      "# closure-tracks-null: shaking, background, readout (frames), seed, adopted, largest share of a refused named "
      "effect, its name, share of the latent one, held-out, floor (px), words, seconds; each condition has seeds of "
      "its "
      "own\n");
  int n_false = 0, n = 0;
  ClosureTracksOptions of_condition = options;
  RecordSetup setup = setup_for(options);
  for (const Shaking shaking : {Shaking::kGround, Shaking::kWind}) {
    for (const bool background : {true, false}) {
      for (const double readout : {0.0, 0.7, 1.0}) {
        setup.shaking = shaking, setup.background = background, setup.readout_frames = readout;
        n_false += print_nulls(of_condition, setup);
        n += options.n_seeds;
        of_condition.first_seed += options.n_seeds;
      }
    }
  }
  fmt::print("closure-tracks-false\t{}\t{}\n", n_false, n);
}

}  // namespace tools
