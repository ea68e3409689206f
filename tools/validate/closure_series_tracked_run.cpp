// Residual diagnosis of displacements measured from tracks: named effects, their values, the modes after correction.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_series_tracked.h"
#include "tools/validate/closure_tracks.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::simulation::Scene;

constexpr std::size_t kTrackedSurrogates = 64;

app::ResponseAnalysis close(const TrackedSeries& series, std::uint64_t seed) {
  app::ResponseOptions options;
  options.clock = series.clock;
  options.n_surrogates = kTrackedSurrogates;
  options.seed = seed;
  return app::analyse_response(series.series, options);
}

std::string names(const app::ResponseAnalysis& found) {
  return found.adopted.empty() ? "nothing" : fmt::format("{}", fmt::join(found.adopted, " + "));
}

std::string refusals(const app::ResponseAnalysis& found) {
  std::string out;
  for (const auto& one : found.result.refused)
    out += fmt::format("[{} {:.4g}: {}]", one.effect, one.score, one.refusal);
  return out;
}

std::string case_line(const TrackedCase& one, std::uint64_t seed) {
  Scene scene = tracked_scene(seed);
  one.apply(scene, one.size);
  const TrackedSeries series = tracked_series(scene, {.inserted = one.inserted, .average = one.average});
  const app::ResponseAnalysis found = close(series, seed);
  const double truth = one.truth(scene, series);
  double stated = std::nan(""), sigma = stated;
  for (const auto& step : found.result.steps) {
    if (step.effect != one.effect || step.parameters.empty()) continue;
    stated = step.parameters.front().value, sigma = step.parameters.front().sigma.value_or(std::nan(""));
  }
  const bool repaired =
      std::any_of(found.repairs.begin(), found.repairs.end(), [](auto& words) { return !words.empty(); });
  const PoleErrors errors = repaired ? pole_errors(found.before, found.after, scene) : PoleErrors{};
  return fmt::format("series-tracked\t{}\t{}\t{}\t{}\t{:.4g}\t{:.4g}\t{:.3g}\t{}\t{:.4f}\t{:.4f}\t{:.4f}\t{:.4f}\t{}\n",
                     one.name, one.strength, seed, names(found), truth, stated, sigma, errors.n, errors.pole[0],
                     errors.pole[1], errors.frequency[0], errors.frequency[1], refusals(found));
}

}  // namespace

void print_closure_series_tracked(const ClosureTracksOptions& options) {
  fmt::print(
      "# displacements from 120 s of tracks: case, strength, seed, named, the effect's true number, the stated one, "
      "its "
      "sigma; true modes found before and after the repair (0: nothing to repair), rms error of their poles before, "
      "after, of their frequencies before, after (%); refused\n");
  for (const TrackedCase& one : tracked_cases()) {
    if (!options.effect.empty() && options.effect != one.name) continue;
    const auto lines = for_each_seed(options, [&](std::uint64_t seed) { return case_line(one, seed); });
    for (const std::string& text : lines) fmt::print("{}", text);
    std::fflush(stdout);
  }
}

void print_closure_series_tracked_null(const ClosureTracksOptions& options) {
  fmt::print(
      "# displacements from 120 s of tracks without an effect in clock or structure: what else it has, seed, adopted, "
      "refused\n");
  const auto lines = for_each_seed(options, [&](std::uint64_t seed) {
    const TrackedNull null = tracked_null(seed);
    const app::ResponseAnalysis found = close(tracked_series(null.scene, {.shimmer_px = null.shimmer_px}), seed);
    return fmt::format("series-tracked-null\t{}\t{}\t{}\t{}\n", null.words, seed, names(found), refusals(found));
  });
  for (const std::string& text : lines) fmt::print("{}", text);
}

}  // namespace tools
