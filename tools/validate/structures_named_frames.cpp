// Frames, matrices and mode tables for the figure of named effects.
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <numbers>

#include "core/simulation/structure/structure_builders.h"
#include "core/structure/kinds/frame2d.h"
#include "core/structure/kinds/matrices.h"
#include "core/structure/kinds/modes.h"
#include "core/structure/kinds/shear_storeys.h"
#include "core/types/constants.h"
#include "tools/validate/structures_elements.h"
#include "tools/validate/structures_named.h"

namespace tools {
namespace {

using namespace core::structure;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr int kLines = 6, kInLine = 10;  // members of the portal, textbook elements in each
constexpr Index kPortalNodes = kLines * kInLine + 1;

struct Corner {
  double x, z;
};
constexpr std::array<Corner, kLines + 1> kCorners{{{0, 0}, {0, 2}, {0, 4}, {3, 4}, {6, 4}, {6, 2}, {6, 0}}};
constexpr std::array<double, kLines> kPortalEi{1.0, 1.0, 1.6, 1.6, 0.8, 0.8};  // MN m^2
constexpr double kPortalEa = 400.0, kPortalMass = 1e-4;  // MN and Gg/m: kg/m times 1e-6, so that lambda is in 1/s^2

Index portal_dof(Index node, Index motion) { return 3 * node + motion; }  // x, z, turn

// How the portal departs from its declaration.
struct PortalChange {
  std::array<double, kLines> ratio{1, 1, 1, 1, 1, 1};  // of the members' stiffness
  double shear_ratio = 0.0;                            // E over kappa G
  double length = 1.0;                                 // factor of all
  std::size_t rigid_member = 0, rigid_count = 0;       // from 1; elements that are rigid at one end of it
  bool rigid_is_last = false;
};

// Matrices of the portal with nothing held.
struct Portal {
  MatrixXd stiffness = MatrixXd::Zero(3 * kPortalNodes, 3 * kPortalNodes), mass = stiffness;
  explicit Portal(const PortalChange& change) {
    for (int line = 0; line < kLines; ++line) {
      const auto at = static_cast<std::size_t>(line);
      if (change.shear_ratio > 0.0) {
        add_sheared(line, change.shear_ratio);
        continue;
      }
      for (int e = 0; e < kInLine; ++e) {
        const int from_end = change.rigid_is_last ? kInLine - 1 - e : e;
        const bool is_rigid = change.rigid_member == at + 1 && from_end < static_cast<int>(change.rigid_count);
        const Corner a = kCorners[at], b = kCorners[at + 1];
        add_plane_element(stiffness, mass, line * kInLine + e,
                          {(b.x - a.x) * change.length / kInLine, (b.z - a.z) * change.length / kInLine,
                           change.ratio[at] * kPortalEi[at] * (is_rigid ? 1e4 : 1.0),
                           change.ratio[at] * kPortalEa * (is_rigid ? 1e4 : 1.0), kPortalMass});
      }
    }
  }

 private:
  void add_sheared(int line, double shear_ratio) {
    constexpr int kInOne = static_cast<int>(kShearNodes) - 1;
    const auto at = static_cast<std::size_t>(line);
    const Corner a = kCorners[at], b = kCorners[at + 1];
    for (int e = 0; e < kInLine; e += kInOne)
      add_plane_shear_element(
          stiffness, mass, line * kInLine + e,
          {(b.x - a.x) * kInOne / kInLine, (b.z - a.z) * kInOne / kInLine, kPortalEi[at], kPortalEa, kPortalMass},
          kPortalEa / shear_ratio);
  }
};

Frame2d declared_portal() {
  Frame2d out;
  for (std::size_t i = 0; i < kCorners.size(); ++i) {
    const bool foot = i == 0 || i + 1 == kCorners.size();
    const Connection held = foot ? Connection::rigid() : Connection::free();
    out.nodes.push_back({"n" + std::to_string(i + 1), kCorners[i].x, kCorners[i].z, 0.0, held, held, held});
  }
  for (std::size_t i = 0; i < kLines; ++i)
    out.members.push_back({"m" + std::to_string(i + 1),
                           out.nodes[i].name,
                           out.nodes[i + 1].name,
                           kPortalEi[i],
                           kPortalEa,
                           kPortalMass,
                           {},
                           0.0,
                           {}});
  return out;
}

}  // namespace

NamedCase draw_frame2d(const std::string& effect, Draw& draw) {
  constexpr double kLength = 3.0;  // largest member, by which the model scales its supports
  NamedCase out;
  PortalChange change;
  const int member = draw.whole(1, kLines), inner = draw.whole(1, kLines - 1), foot = draw.whole(0, 1);
  if (effect == "soft_part") {
    out.place = static_cast<std::size_t>(member), out.size = draw.uniform(0.4, 0.8);
    change.ratio[out.place - 1] = out.size;
  } else if (effect == "shear_flexibility") {  // E over kappa G, in units of 3
    change.shear_ratio = draw.log_uniform(5.0, 50.0), out.size = change.shear_ratio / 3.0;
  } else if (effect == "rigid_offset") {  // in units of an element, a tenth of the member
    change.rigid_member = static_cast<std::size_t>(member), change.rigid_is_last = draw.whole(0, 1) == 1;
    change.rigid_count = static_cast<std::size_t>(draw.whole(2, 4));
    out.place = 2 * change.rigid_member - (change.rigid_is_last ? 0 : 1);
    out.size = static_cast<double>(change.rigid_count);
  } else if (effect == "temperature") {
    warm(out, draw);
    change.ratio.fill(1.0 + kWarmPerKelvin * out.size);
  } else if (effect == "length_scale") {
    change.length = out.size = drawn_length(draw);
  }
  Portal portal(change);
  const Index foot_node = foot == 0 ? 0 : kPortalNodes - 1;
  double turning = 1e9, yielding = 1e9;
  if (effect == "added_mass") {
    const double share = draw.uniform(0.04, 0.15), whole = kPortalMass * 14.0;
    out.place = static_cast<std::size_t>(inner), out.size = share / 0.05;
    for (Index motion = 0; motion < 2; ++motion) {
      const Index at = portal_dof(inner * kInLine, motion);
      portal.mass(at, at) += share * whole;
    }
  } else if (effect == "support_turning") {
    const double flexibility = draw.uniform(0.05, 0.4) * kLength / 1.6;
    out.place = static_cast<std::size_t>(foot) + 1, out.size = flexibility / (0.1 * kLength / 1.6);
    turning = 1.0 / flexibility;
  } else if (effect == "support_yielding") {  // sideways
    const double unit = kLength * kLength * kLength / 1.6;
    const double flexibility = draw.log_uniform(1e-3, 8e-3) * unit;
    out.place = foot == 0 ? 1 : 3, out.size = flexibility / (0.1 * unit);  // x and z of both feet
    yielding = 1.0 / flexibility;
  }
  for (const Index node : {Index{0}, kPortalNodes - 1}) {
    for (Index motion = 0; motion < 3; ++motion) {
      const double given = motion == 2 ? turning : motion == 0 ? yielding : 1e9;
      portal.stiffness(portal_dof(node, motion), portal_dof(node, motion)) += node == foot_node ? given : 1e9;
    }
  }
  const int n_places = draw.whole(5, 8);
  std::vector<Sight> sights;
  out.truth = {portal.stiffness, portal.mass, MatrixXd::Zero(n_places, portal.stiffness.rows())};
  for (int i = 0; i < n_places; ++i) {
    const auto node = static_cast<Index>(std::lround((i + 0.7) / (n_places + 0.4) * (kPortalNodes - 1)));
    const auto line = static_cast<std::size_t>(std::min<Index>(node / kInLine, kLines - 1));
    const double along = static_cast<double>(node) / kInLine - static_cast<double>(line);
    const Corner a = kCorners[line], b = kCorners[line + 1];
    const bool lies = a.z == b.z;  // a beam is seen moving up and down, a column sideways
    out.truth.seen(i, portal_dof(node, lies ? 1 : 0)) = 1.0;
    sights.push_back({"r" + std::to_string(i + 1),
                      {a.x + along * (b.x - a.x), 0.0, a.z + along * (b.z - a.z)},
                      lies ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX()});
  }
  out.declared = declared_as(make_frame2d(declared_portal(), std::move(sights)), effect);
  return out;
}

NamedCase draw_storeys(const std::string& effect, Draw& draw) {
  const int n = draw.whole(6, 8);
  ShearFrame frame;
  core::simulation::ShearBuilding building;
  for (int i = 0; i < n; ++i) {
    frame.mass.push_back(draw.uniform(0.8, 1.2));
    frame.stiffness_per_s2.push_back(2000.0 * draw.uniform(0.8, 1.2));
  }
  building.mass_kg = frame.mass, building.stiffness_n_per_m = frame.stiffness_per_s2;
  double mean_mass = 0.0, mean_stiffness = 0.0;
  for (int i = 0; i < n; ++i) {
    mean_mass += frame.mass[static_cast<std::size_t>(i)] / n;
    mean_stiffness += frame.stiffness_per_s2[static_cast<std::size_t>(i)] / n;
  }
  NamedCase out;
  const auto place = static_cast<std::size_t>(draw.whole(1, n));
  if (effect == "soft_part") {
    out.place = place, out.size = draw.uniform(0.4, 0.8);
    building.stiffness_n_per_m[place - 1] *= out.size;
  } else if (effect == "added_mass") {  // in units of 0.2 of a storey's mean mass
    out.place = place, out.size = draw.uniform(1.0, 4.0);
    building.mass_kg[place - 1] += 0.2 * out.size * mean_mass;
  } else if (effect == "weight_softening") {  // g / h in units of 10 / s^2
    const double stability = draw.uniform(0.05, 0.2);
    const double over_height = stability * frame.stiffness_per_s2[0] / (n * mean_mass);
    out.size = over_height / 10.0;
    building.storey_height_mm.assign(static_cast<std::size_t>(n), 1e3 * core::kStandardGravity_m_s2 / over_height);
  }
  if (effect == "temperature") {
    warm(out, draw);
    for (double& k : building.stiffness_n_per_m) k *= 1.0 + kWarmPerKelvin * out.size;
  }
  core::simulation::StructureModel model =
      core::simulation::shear_frame(building, core::simulation::ModalDamping{{0.01}});
  if (effect == "support_turning") {  // the foundation rocks: k h^2 over its stiffness, in units of 0.02
    const double rocking = draw.uniform(0.005, 0.05);
    out.size = rocking / 0.02;
    Eigen::VectorXd height(n);
    for (int i = 0; i < n; ++i) height(i) = i + 1.0;
    const Eigen::VectorXd force = model.stiffness * height;
    const double flexibility = rocking / mean_stiffness;
    model.stiffness -= flexibility / (1.0 + flexibility * height.dot(force)) * force * force.transpose();
  }
  out.truth = {model.stiffness, model.mass, model.displacement};
  std::vector<Sight> sights;
  for (int i = 0; i < n; ++i)
    sights.push_back({"r" + std::to_string(i + 1), {0.0, 0.0, i + 1.0}, Eigen::Vector3d::UnitX()});
  out.declared = declared_as(make_shear_storeys(frame, std::move(sights)), effect);
  return out;
}

NamedCase draw_matrices(const std::string& effect, Draw& draw) {
  TrueBar bar(TrueBar::Ends::kFoot);
  const auto nodes = bar.look(draw.whole(5, 8));
  NamedCase out;
  MatrixStructure declared;
  declared.stiffness = bar.matrices().stiffness.sparseView(), declared.mass = bar.matrices().mass.sparseView();
  declared.n_modes = kMostNamedModes;
  for (std::size_t i = 1; i <= kNamedParts; ++i)
    declared.groups.push_back({"g" + std::to_string(i), bar.part(i).sparseView(), {}, 0.0});
  for (std::size_t i = 0; i < nodes.size(); ++i)
    declared.seen.push_back({"r" + std::to_string(i + 1), {{2 * nodes[i] - 2, 1.0}}});
  if (effect == "temperature") {
    warm(out, draw);
    for (std::size_t i = 1; i <= kNamedParts; ++i) bar.scale_part(i, 1.0 + kWarmPerKelvin * out.size);
  } else {
    out.place = static_cast<std::size_t>(draw.whole(1, static_cast<int>(kNamedParts)));
    out.size = draw.uniform(0.4, 0.8);
    bar.scale_part(out.place, out.size);
  }
  out.truth = bar.matrices();
  out.declared = declared_as(make_matrices(declared), effect);
  return out;
}

// Valid for small changes only: a loss of 4 to 10 %.
NamedCase draw_mode_table(const std::string&, Draw& draw) {
  TrueBar bar(TrueBar::Ends::kFoot);
  const auto nodes = bar.look(draw.whole(5, 8));
  const TrueMatrices& before = bar.matrices();
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(before.stiffness, before.mass);
  ModeTable table;
  for (std::size_t i = 0; i < nodes.size(); ++i) table.channels.push_back("r" + std::to_string(i + 1));
  for (std::size_t i = 1; i <= kNamedParts; ++i) table.parameters.push_back("part_" + std::to_string(i));
  for (Index r = 0; r < static_cast<Index>(kMostNamedModes); ++r) {
    const Eigen::VectorXd phi = solver.eigenvectors().col(r);
    const double lambda = solver.eigenvalues()(r);
    ModeTable::Mode mode;
    mode.frequency_hz = std::sqrt(lambda) / (2.0 * std::numbers::pi);
    const Eigen::VectorXd shape = before.seen * phi;
    mode.shape.assign(shape.data(), shape.data() + shape.size());
    for (std::size_t i = 1; i <= kNamedParts; ++i)
      mode.sensitivity.push_back(0.5 * phi.dot(bar.part(i) * phi) / lambda);
    table.modes.push_back(std::move(mode));
  }
  NamedCase out;
  out.place = static_cast<std::size_t>(draw.whole(1, static_cast<int>(kNamedParts)));
  out.size = draw.uniform(0.9, 0.96);
  bar.scale_part(out.place, out.size);
  out.truth = bar.matrices();
  out.declared = declare(make_modes(table), kMostNamedModes);
  return out;
}

}  // namespace tools
