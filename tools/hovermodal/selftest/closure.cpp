// Closing the loop at the structure level: what it finds where the missing effect is known, and where there is none.
#include <fmt/format.h>

#include <algorithm>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "core/simulation/random_stream.h"
#include "tools/hovermodal/selftest/closure_structures.h"
#include "tools/hovermodal/selftest/identification.h"
#include "tools/hovermodal/selftest/identification_parallel.h"

namespace tools {
namespace {

using core::closure::ClosureResult;

constexpr double kSigma = 0.0015;  // of each frequency, relative

ClosureResult close(const KnownStructure& structure, std::uint64_t seed) {
  core::structure::DeclaredFrame declared;
  declared.n_storeys = structure.frequency_hz.size();
  declared.simulated = structure.simulated;
  core::simulation::RandomStream noise(seed, "closure." + structure.effect);
  std::vector<core::structure::ReferenceMode> reference;
  for (const double hz : structure.frequency_hz) {
    core::structure::ReferenceMode mode;
    mode.number = static_cast<int>(reference.size()) + 1;
    mode.frequency_hz = hz * (1.0 + kSigma * noise.gaussian());
    mode.sigma_hz = kSigma * mode.frequency_hz;
    reference.push_back(mode);
  }
  core::closure::StructureLevel level(declared, reference);
  core::closure::ClosureOptions options;
  options.seed = seed;
  return core::closure::close_loop(level, options);
}

// How often: named alone, named with rivals, only among the rivals, another effect beside or instead, nothing.
struct Counts {
  int alone = 0, first_of_rivals = 0, among_rivals = 0, wrong = 0, nothing = 0;
};

void count(const ClosureResult& result, const std::string& truth, Counts& counts) {
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
  }
}

void print(const IdentificationOptions& options, bool null) {
  fmt::print(
      "# six frequencies with {:g} % noise of a uniform frame that lacks one effect; records, uniform frame's rms "
      "error "
      "%; named alone, named with rivals, among the rivals, wrong, nothing named\n",
      1e2 * kSigma);
  for (const KnownStructure& structure : known_structures()) {
    if ((structure.effect == "none") != null) continue;
    const auto results = for_each_seed(
        options.n_seeds, options.n_threads, [&](std::uint64_t seed) { return close(structure, seed); },
        options.first_seed);
    Counts counts;
    double rms = 0.0;
    for (const ClosureResult& result : results) {
      count(result, structure.effect, counts);
      rms += result.baseline_rms / options.n_seeds;
    }
    fmt::print("closure\t{}\t{}\t{:.2f}\t{}\t{}\t{}\t{}\t{}\n", structure.effect, options.n_seeds, rms, counts.alone,
               counts.first_of_rivals, counts.among_rivals, counts.wrong, counts.nothing);
  }
}

}  // namespace

void print_closure(const IdentificationOptions& options) { print(options, false); }
void print_closure_null(const IdentificationOptions& options) { print(options, true); }

}  // namespace tools
