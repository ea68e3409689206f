// Mechanisms of damping told by damping over frequency, where the truth is the simulator's damping matrix.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/simulation/structure/beam_builders.h"
#include "core/simulation/structure/structure_builders.h"
#include "core/structure/damping_law.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/structures_named.h"

namespace tools {
namespace {

using core::structure::DampingLaw;
using core::structure::DampingLawFit;

struct DampedTruth {
  core::simulation::StructureModel model;
  double per_hz = 0.0, hz = 0.0, ratio = 0.0;  // of the true law
};

core::simulation::StructureModel undamped(bool is_tower, Draw& draw, const core::simulation::Damping& damping) {
  if (is_tower)
    return core::simulation::cantilever({1e3 * draw.uniform(20.0, 40.0), 24, 3e8, 160.0, draw.uniform(0.0, 800.0)},
                                        damping);
  core::simulation::ShearBuilding building;
  for (int i = 0; i < 7; ++i) {
    building.mass_kg.push_back(draw.uniform(0.8, 1.2));
    building.stiffness_n_per_m.push_back(2000.0 * draw.uniform(0.8, 1.2));
  }
  return core::simulation::shear_frame(building, damping);
}

// zeta of 0.5 to 2 % in the lowest modes.
DampedTruth drawn(DampingLaw law, Draw& draw) {
  using namespace core::simulation;
  const bool is_tower = draw.uniform(0.0, 1.0) < 0.5;
  const double zeta = draw.log_uniform(0.005, 0.02);
  DampedTruth out;
  out.model = undamped(is_tower, draw, ModalDamping{{zeta}});
  const auto modes = modes_of(out.model);
  const double f1 = modes[0].frequency_hz, f2 = modes[1].frequency_hz, f3 = modes[2].frequency_hz;
  if (law == DampingLaw::kConstant) {
    out.ratio = zeta;
  } else if (law == DampingLaw::kMassProportional) {
    out.hz = zeta * f1;
  } else if (law == DampingLaw::kStiffnessProportional) {
    out.per_hz = zeta / f2;
  } else {  // the same ratio in the first and the third mode
    out.per_hz = zeta / (f1 + f3), out.hz = out.per_hz * f1 * f3;
  }
  if (law != DampingLaw::kConstant)
    set_damping(out.model, RayleighDamping{4.0 * std::numbers::pi * out.hz, out.per_hz / std::numbers::pi});
  return out;
}

struct Told {
  bool alone = false, is_possible = false, inside = false;
  double before = 0.0, after = 0.0;
  std::string instead;
};

Told told(DampingLaw law, std::uint64_t seed) {
  Draw draw(seed, fmt::format("damping.{}", name_of(law)));
  const DampedTruth truth = drawn(law, draw);
  const auto modes = modes_of(truth.model);
  // As flights of one to five minutes state them.
  const double share = draw.log_uniform(0.05, 0.2);
  const int n_modes = draw.whole(3, static_cast<int>(kMostNamedModes));
  std::vector<core::structure::ReferenceMode> reference;
  for (int r = 0; r < n_modes; ++r) {
    const auto& mode = modes[static_cast<std::size_t>(r)];
    core::structure::ReferenceMode one;
    one.number = r + 1, one.frequency_hz = mode.frequency_hz, one.sigma_hz = 1e-3 * mode.frequency_hz;
    one.damping_sigma = share * mode.damping_ratio;
    one.damping_ratio = mode.damping_ratio + one.damping_sigma * draw.gaussian();
    reference.push_back(one);
  }
  const auto verdict = damping_verdict(reference);
  const auto left = verdict.possible();
  Told out;
  out.alone = left.size() == 1 && left.front() == law;
  out.is_possible = std::find(left.begin(), left.end(), law) != left.end();
  for (const DampingLaw one : left) out.instead += (out.instead.empty() ? "" : "+") + std::string(name_of(one));
  const DampingLawFit& fit = verdict.laws[static_cast<std::size_t>(law)];
  const auto holds = [](double value, double sigma, double exact) { return std::abs(value - exact) <= 1.96 * sigma; };
  out.inside = law == DampingLaw::kConstant                ? holds(fit.ratio, fit.ratio_sigma, truth.ratio)
               : law == DampingLaw::kStiffnessProportional ? holds(fit.per_hz, fit.per_hz_sigma, truth.per_hz)
                                                           : holds(fit.hz, fit.hz_sigma, truth.hz);
  // Before: the same ratio in every mode, as a damping that is not looked into.
  out.before = verdict.laws[static_cast<std::size_t>(DampingLaw::kConstant)].heldout_percent;
  out.after = fit.heldout_percent;
  return out;
}

double middle(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

void print_structure_damping(int n_seeds, int n_threads, int first_seed) {
  fmt::print(
      "# one mechanism of damping, in towers and buildings of the simulator: mechanism, records; reported and nothing "
      "else; not distinguished, the true one among those left; coefficient within the 95 % interval, of the reported; "
      "held-out error of the damping ratio with a constant ratio and with the law, %, medians; what was left "
      "instead\n");
  const std::pair<DampingLaw, const char*> laws[] = {{DampingLaw::kMassProportional, "mass_proportional"},
                                                     {DampingLaw::kStiffnessProportional, "stiffness_proportional"},
                                                     {DampingLaw::kConstant, "constant"},
                                                     {DampingLaw::kRayleigh, "rayleigh"}};
  for (const auto& [law, name] : laws) {
    const auto all = for_each_seed(
        n_seeds, n_threads, [&, which = law](std::uint64_t seed) { return told(which, seed); }, first_seed);
    int alone = 0, rival = 0, inside = 0;
    std::vector<double> before, after;
    std::string instead;
    for (const Told& one : all) {
      alone += one.alone ? 1 : 0, rival += !one.alone && one.is_possible ? 1 : 0;
      inside += one.alone && one.inside ? 1 : 0;
      before.push_back(one.before), after.push_back(one.after);
      if (!one.alone) instead += " " + (one.instead.empty() ? "none" : one.instead);
    }
    fmt::print("damping\t{}\t{}\t{}\t{}\t{}\t{:.3f}\t{:.3f}\t{}\n", name, all.size(), alone, rival, inside,
               middle(before), middle(after), instead.empty() ? " -" : instead);
  }
}

}  // namespace tools
