// Two masts in one frame for the figure of named effects: a spring between them that is not declared.
#include <array>
#include <cmath>
#include <string>

#include "core/structure/kinds/frame2d.h"
#include "tools/validate/structures_elements.h"
#include "tools/validate/structures_named.h"

namespace tools {
namespace {

using namespace core::structure;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr Index kLevels = 3, kInLevel = 8, kMastNodes = kLevels * kInLevel + 1;
constexpr double kLevel_m = 1.5, kApart_m = 3.0, kMastEa = 400.0, kMastMass = 1e-4;  // MN, Gg/m
constexpr std::array<double, 2> kMastEi{1.0, 0.7};                                   // MN m^2

Frame2d declared_masts() {
  Frame2d out;
  for (std::size_t mast = 0; mast < 2; ++mast) {
    const std::string side = mast == 0 ? "a" : "b";
    for (Index level = 0; level <= kLevels; ++level) {
      const Connection held = level == 0 ? Connection::rigid() : Connection::free();
      out.nodes.push_back({side + std::to_string(level), kApart_m * static_cast<double>(mast),
                           kLevel_m * static_cast<double>(level), 0.0, held, held, held});
      if (level == 0) continue;
      out.members.push_back({side + "_" + std::to_string(level),
                             side + std::to_string(level - 1),
                             side + std::to_string(level),
                             kMastEi[mast],
                             kMastEa,
                             kMastMass,
                             {},
                             0.0,
                             {}});
    }
  }
  for (Index level = 1; level <= kLevels; ++level)
    out.couplings.push_back({"a" + std::to_string(level), "b" + std::to_string(level), 0.0});
  return out;
}

}  // namespace

NamedCase draw_masts(const std::string& effect, Draw& draw) {
  constexpr double kUnit = 1.0 / (kLevel_m * kLevel_m * kLevel_m);  // E I over the cube of a member's length
  NamedCase out;
  out.truth.stiffness = MatrixXd::Zero(6 * kMastNodes, 6 * kMastNodes), out.truth.mass = out.truth.stiffness;
  const auto node_at = [](Index mast, Index i) { return mast * kMastNodes + i; };
  for (Index mast = 0; mast < 2; ++mast) {
    for (Index i = 0; i + 1 < kMastNodes; ++i)
      add_plane_element(
          out.truth.stiffness, out.truth.mass, node_at(mast, i),
          {0.0, kLevel_m / static_cast<double>(kInLevel), kMastEi[static_cast<std::size_t>(mast)], kMastEa, kMastMass});
    for (Index motion = 0; motion < 3; ++motion)
      out.truth.stiffness(3 * node_at(mast, 0) + motion, 3 * node_at(mast, 0) + motion) += 1e9;
  }
  const int level = draw.whole(1, static_cast<int>(kLevels));
  out.place = static_cast<std::size_t>(level), out.size = draw.log_uniform(0.02, 0.15);
  const Index a = 3 * node_at(0, level * kInLevel), b = 3 * node_at(1, level * kInLevel);
  for (const Index i : {a, b}) {
    for (const Index j : {a, b}) out.truth.stiffness(i, j) += (i == j ? 1.0 : -1.0) * out.size * kUnit;
  }
  const int n_places = draw.whole(5, 8);
  out.truth.seen = MatrixXd::Zero(n_places, out.truth.stiffness.rows());
  std::vector<Sight> sights;
  for (int i = 0; i < n_places; ++i) {
    const Index mast = i % 2;
    const auto own = (n_places + (mast == 0 ? 1 : 0)) / 2;  // places on this mast
    const auto node = static_cast<Index>(std::lround((i / 2 + 1.0) / own * (kMastNodes - 1)));
    out.truth.seen(i, 3 * node_at(mast, node)) = 1.0;
    sights.push_back({"r" + std::to_string(i + 1),
                      {kApart_m * static_cast<double>(mast), 0.0,
                       kLevel_m * static_cast<double>(node) / static_cast<double>(kInLevel)},
                      Eigen::Vector3d::UnitX()});
  }
  out.declared = declared_as(make_frame2d(declared_masts(), std::move(sights)), effect);
  return out;
}

}  // namespace tools
