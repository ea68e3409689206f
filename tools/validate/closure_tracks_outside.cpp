// Records with an effect that the catalogue lacks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "core/closure/observation/latent_words.h"
#include "core/closure/observation/observation_level.h"
#include "core/closure/observation/point_motion_model.h"
#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_tracks.h"
#include "tools/validate/closure_tracks_run.h"
#include "tools/validate/foreign_effects.h"
#include "tools/validate/foreign_scene.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::closure::ObservationRecord;
using core::simulation::Scene;

// Describes the leading pattern of the effect's true contribution beyond the free motions, without noise, in the same
// form.
std::string true_words(const ObservationRecord& with, const ObservationRecord& without) {
  const core::closure::PointMotionModel model(without);
  Eigen::MatrixXd change(2 * without.n_points(), without.n_frames());
  for (Eigen::Index j = 0; j < without.n_points(); ++j) {
    change.row(2 * j) = (with.u_px.col(j) - without.u_px.col(j)).transpose() * model.weight()(2 * j);
    change.row(2 * j + 1) = (with.v_px.col(j) - without.v_px.col(j)).transpose() * model.weight()(2 * j + 1);
  }
  const Eigen::MatrixXd left = model.left_of(change);
  const Eigen::VectorXd pattern = core::closure::leading_pattern(Eigen::MatrixXd(left * left.transpose()));
  return core::closure::latent_words(pattern.cwiseQuotient(model.weight()), pattern.transpose() * left, without,
                                     model.geometry(), {});
}

// Numbers of latent_words(): shares in percent, Hz.
struct Description {
  double along_v, plane, quadratic, hz;
};
Description read_words(const std::string& words) {
  const auto number_at = [&](std::size_t at) {
    if (at == words.npos) throw std::logic_error("not the words of a latent effect: " + words);
    return std::atof(words.c_str() + at);
  };
  const auto number_after = [&](const std::string& start) {
    const std::size_t at = words.find(start);
    return number_at(at == words.npos ? at : at + start.size());
  };
  const std::size_t along = words.find(" % of it along v"), comma = words.rfind(", ", along);
  return {number_at(along == words.npos || comma == words.npos ? words.npos : comma + 2),
          number_after("a linear field over the image explains "), number_after(", a quadratic one "),
          number_after("strongest at ")};
}

// Whether the description of the first latent effect agrees with the truth within a fifth of the whole, and 0.3 Hz.
bool described(const core::closure::ClosureResult& result, const std::string& truth) {
  constexpr double kShare = 20.0, kHz = 0.3;
  const auto latent = std::find_if(result.steps.begin(), result.steps.end(),
                                   [](const auto& s) { return s.kind == core::closure::EffectKind::kLatent; });
  if (latent == result.steps.end()) return false;
  const Description said = read_words(latent->meaning), is = read_words(truth);
  return std::abs(said.along_v - is.along_v) <= kShare && std::abs(said.plane - is.plane) <= kShare &&
         std::abs(said.quadratic - is.quadratic) <= kShare && std::abs(said.hz - is.hz) <= kHz;
}

// All effects latent; or, if another effect of the catalogue can absorb it, that effect named with its rivals.
bool answered(const core::closure::ClosureResult& result, const std::string& effect) {
  const bool absorbed = effect == "radial distortion" || effect == "tangential distortion";
  return !result.steps.empty() && std::all_of(result.steps.begin(), result.steps.end(), [&](const auto& s) {
    return s.kind == core::closure::EffectKind::kLatent || (absorbed && !s.rivals.empty());
  });
}

struct OutsideCase {
  Scene scene;
  ObservationRecord with, without;
  double noise_px;
};
OutsideCase own_case(const HiddenEffect& effect, const RecordSetup& setup, double strength, std::uint64_t seed) {
  const Scene declared = closure_scene(setup, seed);
  const Scene scene = with_effects({&effect}, declared, strength, setup.background).scene;
  return {scene, observation_record(scene, declared, setup.background),
          observation_record(declared, declared, setup.background), noise_px(declared, setup.background)};
}
OutsideCase foreign_case(const HiddenEffect& effect, const ClosureTracksOptions& options, double strength,
                         std::uint64_t seed) {
  const ForeignScene foreign = draw_foreign_scene(seed, setup_for(options).duration_s, options.flight);
  const Scene scene = with_effects({&effect}, foreign.scene, strength, foreign.background).scene;
  return {scene, foreign_record(scene, foreign), foreign_record(foreign.scene, foreign),
          noise_px(foreign.scene, foreign.background)};
}

std::string outside_line(const char* check, const HiddenEffect& effect, const OutsideCase& made, std::uint64_t seed) {
  const auto& [scene, with, without, noise] = made;
  const TracksOutcome o = close_tracks_record(with, scene, seed, effect.called);
  const double named = close_tracks_record(with, scene, seed).heldout_after();
  const std::string truth = true_words(with, without);
  const EffectStrength is = strength_of(with, without, noise, true);
  const double nan = std::nan("");
  return fmt::format(
      "{}\t{}\t{:.2f}\t{:.3f}\t{}\t{}\t{:d}\t{:d}\t{:.5f}\t{:.5f}\t{:.5f}\t{:.5f}\t{:.4f}\t{:.4f}\t"
      "{}\t{{{}}}\t{:.1f}\n",
      check, effect.name, is.plain, is.visible, seed, o.names(), answered(o.result, effect.name),
      described(o.result, truth), o.result.baseline_rms, o.heldout_after(), o.result.noise_floor, named,
      o.result.reference_error_before.value_or(nan), o.result.reference_error_after.value_or(nan),
      o.words + o.refused(), truth, o.seconds);
}

void print_outside_columns(const char* check) {
  fmt::print(
      "# {}: effect taken out of the catalogue, strength, visible part, seed, adopted, right answer, described as it "
      "is, held-out before, after, floor (px), after with the whole catalogue, modal error before, after (% rms), "
      "words, the truth in the same words, seconds\n",
      check);
}

// Effects that the catalogue has.
template <class MakeCase>
void print_lines(const char* check, const ClosureTracksOptions& options, MakeCase make_case) {
  print_outside_columns(check);
  const double strength = options.strength > 0.0 ? options.strength : 1.0;
  for (const HiddenEffect& effect : hidden_effects()) {
    if (!options.effect.empty() && options.effect != effect.name) continue;
    const auto lines = for_each_seed(options.n_seeds, options.n_threads, [&](std::uint64_t index) {
      const std::uint64_t seed = seed_of(options, index);
      return outside_line(check, effect, make_case(effect, strength, seed), seed);
    });
    for (const std::string& line : lines) fmt::print("{}", line);
    std::fflush(stdout);
  }
}

}  // namespace

void print_closure_tracks_outside(const ClosureTracksOptions& options) {
  const RecordSetup setup = setup_for(options);
  print_lines("closure-tracks-outside", options, [&](const HiddenEffect& effect, double strength, std::uint64_t seed) {
    return own_case(effect, setup, strength, seed);
  });
}

void print_closure_tracks_foreign_outside(const ClosureTracksOptions& options) {
  print_lines("closure-tracks-foreign-outside", options,
              [&](const HiddenEffect& effect, double strength, std::uint64_t seed) {
                return foreign_case(foreign_effect_named(effect.name).effect, options, strength, seed);
              });
}

}  // namespace tools
