// Which of ten storeys or elements lost stiffness: the loop's answer on modes of structures that share no code with the
// model that is fitted: springs and masses, or textbook beam elements, solved by Eigen.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "core/closure/closure_loop.h"
#include "core/closure/structure_level.h"
#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/shear_storeys.h"
#include "core/structure/kinds/tower.h"
#include "tools/validate/drawn_scene.h"
#include "tools/validate/identification_parallel.h"
#include "tools/validate/structures.h"

namespace tools {
namespace {

using core::structure::DeclaredFrame;
using core::structure::ReferenceMode;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kPlaces = 10, kSeenModes = 6, kElements = 4;  // textbook elements in each part
constexpr int kUndamaged = 300;                               // records; most end at the first test
constexpr double kWhereFrequencySigma = 0.001, kWhereShapeSigma = 0.01;

struct Truth {
  VectorXd hz;
  MatrixXd shapes;  // places x modes
};

Truth solve(const MatrixXd& k, const MatrixXd& m, const MatrixXd& seen) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(k, m);
  return {solver.eigenvalues().head(kSeenModes).cwiseSqrt() / (2.0 * std::numbers::pi),
          seen * solver.eigenvectors().leftCols(kSeenModes)};
}

Truth storeys(const VectorXd& factor) {
  MatrixXd k = MatrixXd::Zero(kPlaces, kPlaces);
  for (Index i = 0; i < kPlaces; ++i) {
    const double stiffness = 2000.0 * factor(i);
    k(i, i) += stiffness;
    if (i == 0) continue;
    k(i - 1, i - 1) += stiffness;
    k(i, i - 1) -= stiffness;
    k(i - 1, i) -= stiffness;
  }
  return solve(k, MatrixXd::Identity(kPlaces, kPlaces), MatrixXd::Identity(kPlaces, kPlaces));
}

// A bar of ten parts along its length; held: degrees of freedom (deflection and slope of every node) that are fixed.
Truth bar(const VectorXd& factor, const std::vector<Index>& held) {
  const Index nodes = kPlaces * kElements + 1;
  const double l = 1.0 / static_cast<double>(kElements);
  MatrixXd k = MatrixXd::Zero(2 * nodes, 2 * nodes), m = k, ke(4, 4), me(4, 4);
  ke << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
      4 * l * l;
  me << 156, 22 * l, 54, -13 * l, 22 * l, 4 * l * l, 13 * l, -3 * l * l, 54, 13 * l, 156, -22 * l, -13 * l, -3 * l * l,
      -22 * l, 4 * l * l;
  for (Index e = 0; e + 1 < nodes; ++e) {
    k.block(2 * e, 2 * e, 4, 4) += 2.0e6 * factor(e / kElements) / (l * l * l) * ke;
    m.block(2 * e, 2 * e, 4, 4) += 50.0 * l / 420.0 * me;
  }
  std::vector<Index> kept;
  for (Index d = 0; d < 2 * nodes; ++d) {
    if (std::find(held.begin(), held.end(), d) == held.end()) kept.push_back(d);
  }
  MatrixXd seen = MatrixXd::Zero(kPlaces, 2 * nodes);
  for (Index i = 0; i < kPlaces; ++i) seen(i, 2 * (i * kElements + kElements / 2)) = 1.0;  // middles of the parts
  return solve(k(kept, kept), m(kept, kept), seen(Eigen::all, kept));
}

enum class Kind { kStoreys, kTower, kBeam };

std::vector<core::structure::Sight> places(Kind kind) {
  std::vector<core::structure::Sight> out;
  for (Index i = 0; i < kPlaces; ++i) {
    const double at = static_cast<double>(i) + (kind == Kind::kStoreys ? 1.0 : 0.5);
    core::structure::Sight sight;
    sight.channel = fmt::format("r{}", i + 1);
    sight.at_m = kind == Kind::kBeam ? Eigen::Vector3d(at, 0, 0) : Eigen::Vector3d(0, 0, at);
    sight.direction = kind == Kind::kBeam ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
    out.push_back(std::move(sight));
  }
  return out;
}

DeclaredFrame declared_of(Kind kind) {
  using namespace core::structure;
  if (kind == Kind::kStoreys) {
    ShearFrame frame;
    frame.mass.assign(kPlaces, 1.0), frame.stiffness_per_s2.assign(kPlaces, 2000.0);
    return declare(make_shear_storeys(frame, places(kind)), kSeenModes);
  }
  if (kind == Kind::kTower) {
    Tower tower;
    tower.height_m = kPlaces, tower.ei_nm2 = 2.0e6, tower.mass_per_m_kg = 50.0, tower.parts = kPlaces;
    tower.gravity = false;
    return declare(make_tower(tower, places(kind)), kSeenModes);
  }
  Beam beam;
  beam.spans = {{static_cast<double>(kPlaces), 2.0e6, 50.0, kPlaces}};
  beam.supports.resize(2);
  return declare(make_beam(beam, places(kind)), kSeenModes);
}

struct Answer {
  int effects = 0;
  std::optional<int> place;  // of soft_part, from 1
  int truth = 0;
  double ratio = 0.0;
};

Answer answer(double loss, std::uint64_t seed) {
  const auto kind = static_cast<Kind>(seed % 3);
  Draw draw(seed, fmt::format("where.{}", loss));
  Answer out;
  out.truth = 1 + std::min(static_cast<int>(draw.uniform(0.0, 10.0)), 9);
  VectorXd factor = VectorXd::Ones(kPlaces);
  factor(out.truth - 1) -= loss;
  const Truth truth = kind == Kind::kStoreys ? storeys(factor)
                      : kind == Kind::kTower ? bar(factor, {0, 1})
                                             : bar(factor, {0, 2 * kPlaces * kElements});
  std::vector<ReferenceMode> reference;
  for (Index r = 0; r < kSeenModes; ++r) {
    ReferenceMode mode;
    mode.number = static_cast<int>(r) + 1;
    mode.frequency_hz = truth.hz(r) * (1.0 + kWhereFrequencySigma * draw.gaussian());
    mode.sigma_hz = kWhereFrequencySigma * mode.frequency_hz;
    const double largest = truth.shapes.col(r).cwiseAbs().maxCoeff();
    for (Index i = 0; i < kPlaces; ++i) {
      mode.shape.push_back(truth.shapes(i, r) / largest + kWhereShapeSigma * draw.gaussian());
      mode.shape_sigma.push_back(kWhereShapeSigma);
    }
    reference.push_back(std::move(mode));
  }
  core::closure::StructureLevel level(declared_of(kind), std::move(reference));
  core::closure::ClosureOptions options;
  options.seed = seed;
  options.n_surrogates_when_plain = 32;
  const core::closure::ClosureResult result = core::closure::close_loop(level, options);
  out.effects = static_cast<int>(result.steps.size());
  for (const auto& step : result.steps) {
    if (step.effect != "soft_part") continue;
    out.place = static_cast<int>(std::lround(step.parameters.front().value));
    out.ratio = step.parameters.back().value;
  }
  return out;
}

}  // namespace

void print_structure_where(int n_seeds, int n_threads, int first_seed) {
  fmt::print(
      "# one of ten storeys or elements loses stiffness (frame, tower, beam in turn): loss %, records, reported, soft "
      "part within one place, at the place, another effect as well or instead\n");
  for (const double loss : {0.0, 0.05, 0.1, 0.2, 0.4}) {
    const int n = loss == 0.0 ? kUndamaged : n_seeds;
    const auto answers = for_each_seed(
        n, n_threads, [&](std::uint64_t seed) { return answer(loss, seed); }, first_seed);
    int told = 0, near = 0, exact = 0, other = 0;
    for (const Answer& a : answers) {
      told += a.effects > 0 ? 1 : 0;
      if (a.place) {
        near += std::abs(*a.place - a.truth) <= 1 ? 1 : 0;
        exact += *a.place == a.truth ? 1 : 0;
      }
      other += a.effects > (a.place ? 1 : 0) ? 1 : 0;
    }
    fmt::print("where\t{:g}\t{}\t{}\t{}\t{}\t{}\n", 100.0 * loss, n, told, near, exact, other);
  }
}

}  // namespace tools
