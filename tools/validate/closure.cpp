// Residual diagnosis at the structure level: effects found in structures with one known missing effect, and without
// any.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "tools/validate/closure_effects.h"
#include "tools/validate/closure_structures.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/identification.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::closure::ClosureResult;

constexpr double kSigma = 0.0015;  // of each frequency, relative

// Sigmas unequal over the modes, and stated with an error.
ClosureResult close(const KnownStructure& structure, std::uint64_t seed) {
  constexpr double kUnequal = 0.35, kSigmaError = 0.15;  // sd of the logarithm
  core::structure::DeclaredFrame declared;
  declared.n_storeys = structure.frequency_hz.size();
  declared.simulated = structure.simulated;
  Draw noise(seed, "noise." + structure.effect);
  std::vector<core::structure::ReferenceMode> reference;
  for (const double hz : structure.frequency_hz) {
    core::structure::ReferenceMode mode;
    mode.number = static_cast<int>(reference.size()) + 1;
    const double sigma = kSigma * std::exp(kUnequal * noise.gaussian() - kUnequal * kUnequal);
    mode.frequency_hz = hz * (1.0 + sigma * noise.gaussian());
    mode.sigma_hz = sigma * std::exp(kSigmaError * noise.gaussian()) * mode.frequency_hz;
    reference.push_back(mode);
  }
  core::closure::StructureLevel level(declared, reference);
  core::closure::ClosureOptions options;
  options.seed = seed;
  return core::closure::close_loop(level, options);
}

// Counts of results: named alone, named with rivals, only among the rivals, another effect in addition or instead,
// nothing; of the first two, those with all parameters within three sigma.
struct Counts {
  int alone = 0, first_of_rivals = 0, among_rivals = 0, wrong = 0, nothing = 0, within = 0;
};

void count(const ClosureResult& result, const KnownStructure& structure, Counts& counts) {
  const std::string& truth = structure.effect;
  if (result.steps.empty()) {
    ++counts.nothing;
    return;
  }
  const auto& step = result.steps.front();
  const bool rival = std::find(step.rivals.begin(), step.rivals.end(), truth) != step.rivals.end();
  if (result.steps.size() > 1 || (step.effect != truth && !rival)) {
    ++counts.wrong;
  } else if (step.effect != truth) {
    ++counts.among_rivals;
  } else {
    ++(step.rivals.empty() ? counts.alone : counts.first_of_rivals);
    counts.within += parameter_errors(result.steps, truth, structure.truth).worst_sigmas <= 3.0 ? 1 : 0;
  }
}

void print(const IdentificationOptions& options, bool null) {
  fmt::print(
      "# all frequencies, with {:g} % noise, of a drawn uniform frame that lacks one effect: records, uniform frame's "
      "rms "
      "error %; named alone, named with rivals, among the rivals, wrong, nothing named; of the first two, all "
      "parameters "
      "within 3 sigma\n",
      1e2 * kSigma);
  for (const std::string& effect : known_structures()) {
    if ((effect == "none") != null) continue;
    const auto results = for_each_seed(
        options.n_seeds, options.n_threads,
        [&](std::uint64_t seed) {
          const KnownStructure structure = known_structure(effect, seed);
          return std::pair{structure, close(structure, seed)};
        },
        options.first_seed);
    Counts counts;
    double rms = 0.0;
    for (const auto& [structure, result] : results) {
      count(result, structure, counts);
      rms += result.baseline_rms / options.n_seeds;
    }
    fmt::print("closure\t{}\t{}\t{:.5f}\t{}\t{}\t{}\t{}\t{}\t{}\n", effect, options.n_seeds, rms, counts.alone,
               counts.first_of_rivals, counts.among_rivals, counts.wrong, counts.nothing, counts.within);
  }
}

}  // namespace

void print_closure(const IdentificationOptions& options) { print(options, false); }
void print_closure_null(const IdentificationOptions& options) { print(options, true); }

}  // namespace tools
