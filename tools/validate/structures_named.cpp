// Effects in structures of every kind: the loop's answer where the truth comes from other matrices.
#include "tools/validate/structures_named.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "core/simulation/structure/modal_form.h"
#include "core/structure/mode_numbers.h"
#include "tools/validate/identification_parallel.h"

namespace tools {
namespace {

using core::structure::ReferenceMode;
using Eigen::Index;

// As flights of one to five minutes state them: frequencies 0.05 to 0.2 %, shapes 1 to 3 % of the largest component.
std::vector<ReferenceMode> measured(const TrueMatrices& truth, int n_modes, Draw& draw) {
  const double frequency_sigma = draw.log_uniform(5e-4, 2e-3), shape_sigma = draw.log_uniform(0.01, 0.03);
  const auto form = core::simulation::modal_form(
      truth.mass, Eigen::MatrixXd::Zero(truth.mass.rows(), truth.mass.cols()), truth.stiffness);
  const Eigen::MatrixXd shapes = truth.seen * form.shapes.leftCols(n_modes);
  std::vector<ReferenceMode> out;
  for (Index r = 0; r < n_modes; ++r) {
    ReferenceMode mode;
    mode.number = static_cast<int>(r) + 1;
    mode.frequency_hz = form.w(r) / (2.0 * std::numbers::pi) * (1.0 + frequency_sigma * draw.gaussian());
    mode.sigma_hz = frequency_sigma * mode.frequency_hz;
    const double largest = shapes.col(r).cwiseAbs().maxCoeff();
    for (Index i = 0; i < shapes.rows(); ++i) {
      mode.shape.push_back(shapes(i, r) / largest + shape_sigma * draw.gaussian());
      mode.shape_sigma.push_back(shape_sigma);
    }
    out.push_back(std::move(mode));
  }
  return out;
}

struct Named {
  bool alone = false, is_rival = false, nothing = false;  // named and nothing else; only among the rivals
  bool at_place = false, has_interval = false, inside = false;
  double before = 0.0, after = 0.0;  // held out, %
  std::string instead;
};

Named answer(const NamedKind& kind, std::uint64_t seed) {
  Draw draw(seed, fmt::format("named.{}.{}", kind.kind, kind.effect));
  const NamedCase one = kind.draw(kind.effect, draw);
  auto reference = measured(one.truth, draw.whole(3, static_cast<int>(kMostNamedModes)), draw);
  Named out;
  std::vector<core::structure::ReferenceMode> unpaired = pair_with_model(one.declared, reference);
  out.nothing = reference.size() < 2;  // too few are modes of the model
  if (out.nothing) return out;
  core::closure::StructureLevel level(one.declared, std::move(reference), {}, std::move(unpaired));
  core::closure::ClosureOptions options;
  options.seed = seed, options.n_surrogates_when_plain = 32;
  const core::closure::ClosureResult result = core::closure::close_loop(level, options);
  out.nothing = result.steps.empty();
  if (out.nothing) return out;
  const core::closure::ClosureStep& first = result.steps.front();
  out.before = first.heldout_before, out.after = result.steps.back().heldout_after;
  for (const auto& step : result.steps) out.instead += (out.instead.empty() ? "" : "+") + step.effect;
  if (result.steps.size() > 1) return out;
  out.is_rival = std::find(first.rivals.begin(), first.rivals.end(), kind.effect) != first.rivals.end();
  out.alone = first.effect == kind.effect;
  if (!out.alone) return out;
  out.at_place = one.place == 0 || std::lround(first.parameters.front().value) == static_cast<long>(one.place);
  const auto& size = first.parameters.back();
  out.has_interval = out.at_place && size.sigma.has_value();
  out.inside = out.has_interval && std::abs(size.value - one.size) <= 1.96 * *size.sigma;
  return out;
}

double median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void print_case(const NamedKind& kind, const std::vector<Named>& all) {
  int alone = 0, rival = 0, nothing = 0, place = 0, intervals = 0, inside = 0;
  std::vector<double> before, after;
  std::string instead;
  for (const Named& one : all) {
    alone += one.alone ? 1 : 0;
    rival += !one.alone && one.is_rival ? 1 : 0;
    nothing += one.nothing ? 1 : 0;
    place += one.at_place ? 1 : 0;
    intervals += one.has_interval ? 1 : 0;
    inside += one.inside ? 1 : 0;
    if (!one.nothing) before.push_back(one.before), after.push_back(one.after);
    if (!one.nothing && !one.alone) instead += " " + one.instead;
  }
  fmt::print("named\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{}\t{:.3f}\t{:.3f}\t{}\n", kind.kind, kind.effect, all.size(),
             alone, rival, nothing, place, intervals, inside, median(before), median(after),
             instead.empty() ? " -" : instead);
}

}  // namespace

std::vector<NamedKind> named_kinds() {
  std::vector<NamedKind> out;
  const auto add = [&](const char* kind, auto draw, std::initializer_list<const char*> effects) {
    for (const char* effect : effects) out.push_back({kind, effect, draw});
  };
  add("shear_frame", draw_storeys, {"soft_part", "added_mass", "support_turning", "weight_softening", "temperature"});
  add("tower", draw_tower,
      {"soft_part", "added_mass", "support_turning", "support_yielding", "spring_stiffness", "weight_softening",
       "shear_flexibility", "temperature", "length_scale"});
  add("beam", draw_beam,
      {"soft_part", "added_mass", "support_turning", "support_yielding", "support_restraint", "spring_stiffness",
       "axial_force", "shear_flexibility", "rigid_offset", "temperature", "length_scale"});
  add("cable", draw_cable,
      {"soft_part", "added_mass", "support_restraint", "axial_force", "temperature", "length_scale"});
  add("frame2d", draw_frame2d,
      {"soft_part", "added_mass", "support_turning", "support_yielding", "shear_flexibility", "rigid_offset",
       "temperature", "length_scale"});
  add("frame2d", draw_masts, {"coupling"});
  add("matrices", draw_matrices, {"soft_part", "temperature"});
  add("modes", draw_mode_table, {"soft_part"});
  return out;
}

void print_structure_effects(int n_seeds, int n_threads, int first_seed) {
  fmt::print(
      "# one effect in structures of every kind: kind, effect, records; named and nothing else; another effect named "
      "with the true one among its rivals; nothing named; of the named: at the true place, with an interval there, "
      "size within the 95 % interval; held-out error before and after, %, medians; what was named instead\n");
  for (const NamedKind& kind : named_kinds())
    print_case(kind, for_each_seed(
                         n_seeds, n_threads, [&](std::uint64_t seed) { return answer(kind, seed); }, first_seed));
  print_structure_damping(n_seeds, n_threads, first_seed);
}

}  // namespace tools
