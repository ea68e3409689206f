// Bars for the figure of named effects: matrices of the simulator's cantilever and deck, and the cases made of them.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/simulation/structure/beam_builders.h"
#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/kinds/tower.h"
#include "core/types/constants.h"
#include "tools/validate/structures_named.h"

namespace tools {
namespace {

using namespace core::structure;
using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kElement = 1.0 / static_cast<double>(kNamedElements);
constexpr std::size_t kElementsInPart = kNamedElements / kNamedParts;
constexpr double kEuler = std::numbers::pi * std::numbers::pi;  // Euler's load of the hinged bar

// Textbook elements of length l, E I = 1, tension 1 (Clough & Penzien, Dynamics of Structures, 10.3 to 10.5).
Matrix4d bending() {
  const double l = kElement;
  Matrix4d k;
  k << 12, 6 * l, -12, 6 * l, 6 * l, 4 * l * l, -6 * l, 2 * l * l, -12, -6 * l, 12, -6 * l, 6 * l, 2 * l * l, -6 * l,
      4 * l * l;
  return k / (l * l * l);
}
Matrix4d geometric() {
  const double l = kElement;
  Matrix4d k;
  k << 36, 3 * l, -36, 3 * l, 3 * l, 4 * l * l, -3 * l, -l * l, -36, -3 * l, 36, -3 * l, 3 * l, -l * l, -3 * l,
      4 * l * l;
  return k / (30.0 * l);
}

// Number of a part's end among the model's nodes, and the element node there.
std::size_t node_of(std::size_t part_end) { return part_end * kElementsInPart; }

double drawn_ratio(Draw& draw) {
  return draw.uniform(0.0, 1.0) < 0.5 ? draw.uniform(0.4, 0.7) : draw.uniform(1.5, 2.5);
}

}  // namespace

TrueBar::TrueBar(Ends ends) : ends_(ends) {
  using namespace core::simulation;
  const ModalDamping damping{{0.01}};
  const StructureModel model =
      ends == Ends::kFoot
          ? cantilever({1000.0, static_cast<int>(kNamedElements), 1.0, 1.0, 0.0}, damping)
          : bridge_deck({1000.0, static_cast<int>(kNamedElements) - 1, 1, 1.0, 1.0, BridgeDeck::Ends::kSimple},
                        damping);
  out_.stiffness = model.stiffness, out_.mass = model.mass, influence_ = model.influence;
}

Index TrueBar::dof(std::size_t node, bool turns) const {
  const auto full = static_cast<Index>(2 * node + (turns ? 1 : 0));
  if (ends_ == Ends::kFoot) return full - 2 >= 0 ? full - 2 : -1;
  if (!turns && (node == 0 || node == kNamedElements)) return -1;
  return node == kNamedElements ? full - 2 : full - 1;
}

void TrueBar::add(MatrixXd& to, std::size_t element, const Matrix4d& part) const {
  const Index at[] = {dof(element, false), dof(element, true), dof(element + 1, false), dof(element + 1, true)};
  for (Index i = 0; i < 4; ++i) {
    for (Index j = 0; j < 4; ++j) {
      if (at[i] >= 0 && at[j] >= 0) to(at[i], at[j]) += part(i, j);
    }
  }
}

MatrixXd TrueBar::part(std::size_t number) const {
  MatrixXd out = MatrixXd::Zero(out_.stiffness.rows(), out_.stiffness.cols());
  for (std::size_t e = (number - 1) * kElementsInPart; e < number * kElementsInPart; ++e) add(out, e, bending());
  return out;
}

void TrueBar::scale_part(std::size_t number, double ratio) { out_.stiffness += (ratio - 1.0) * part(number); }

void TrueBar::add_mass(std::size_t node, double share) { out_.mass(dof(node, false), dof(node, false)) += share; }

void TrueBar::add_tension(double newton) {
  for (std::size_t e = 0; e < kNamedElements; ++e) add(out_.stiffness, e, newton * geometric());
}

void TrueBar::add_weight(double newton) {
  for (std::size_t e = 0; e < kNamedElements; ++e) {
    const double middle = (static_cast<double>(e) + 0.5) * kElement;
    add(out_.stiffness, e, -newton * (1.0 - middle) * geometric());
  }
}

void TrueBar::add_spring(std::size_t node, bool turns, double stiffness) {
  out_.stiffness(dof(node, turns), dof(node, turns)) += stiffness;
}

void TrueBar::add_turning(double flexibility) {
  VectorXd rigid = VectorXd::Zero(out_.stiffness.rows());
  for (std::size_t node = 1; node <= kNamedElements; ++node) {
    rigid(dof(node, false)) = static_cast<double>(node) * kElement;
    rigid(dof(node, true)) = 1.0;
  }
  // Inverse of K^-1 + flexibility rigid rigid' (Sherman & Morrison).
  const VectorXd force = out_.stiffness * rigid;
  out_.stiffness -= (flexibility / (1.0 + flexibility * rigid.dot(force))) * force * force.transpose();
}

void TrueBar::release(std::size_t node, double stiffness) {
  const Index n = out_.stiffness.rows();
  VectorXd rigid = VectorXd::Zero(n);
  for (std::size_t i = 0; i <= kNamedElements; ++i) {
    if (dof(i, false) >= 0) rigid(dof(i, false)) = 1.0;
  }
  // Of all held ends together; each one's own lie in its half of the bar.
  VectorXd mass = influence_ - out_.mass * rigid, stiff = -(out_.stiffness * rigid);
  const double ends = ends_ == Ends::kFoot ? 1.0 : 2.0;
  const double own_mass = (1.0 - rigid.dot(out_.mass * rigid) - 2.0 * rigid.dot(mass)) / ends;
  if (node == 0) {
    mass.tail(n / 2).setZero(), stiff.tail(n / 2).setZero();
  } else {
    mass.head(n / 2).setZero(), stiff.head(n / 2).setZero();
  }
  const double own_stiffness = -rigid.dot(stiff);
  const auto extend = [n](MatrixXd& to, const VectorXd& coupling, double own) {
    to.conservativeResize(n + 1, n + 1);
    to.col(n).head(n) = coupling, to.row(n).head(n) = coupling.transpose(), to(n, n) = own;
  };
  extend(out_.mass, mass, own_mass);
  extend(out_.stiffness, stiff, own_stiffness + stiffness);
}

std::vector<std::size_t> TrueBar::look(int n_places) {
  std::vector<std::size_t> nodes;
  out_.seen = MatrixXd::Zero(n_places, out_.stiffness.rows());
  for (int i = 0; i < n_places; ++i) {
    const double share = ends_ == Ends::kFoot ? (i + 1.0) / n_places : (i + 0.7) / (n_places + 0.4);
    nodes.push_back(static_cast<std::size_t>(std::lround(share * static_cast<double>(kNamedElements))));
    out_.seen(i, dof(nodes.back(), false)) = 1.0;
  }
  return nodes;
}

std::vector<Sight> bar_sights(const std::vector<std::size_t>& nodes, bool upright) {
  std::vector<Sight> out;
  for (const std::size_t node : nodes) {
    const double x = static_cast<double>(node) * kElement;
    out.push_back({"r" + std::to_string(out.size() + 1), upright ? Eigen::Vector3d(0, 0, x) : Eigen::Vector3d(x, 0, 0),
                   upright ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ()});
  }
  return out;
}

NamedCase draw_tower(const std::string& effect, Draw& draw) {
  Tower tower;
  tower.height_m = 1.0, tower.ei_nm2 = 1.0, tower.mass_per_m_kg = 1.0, tower.parts = kNamedParts;
  tower.gravity = false;
  TrueBar bar(TrueBar::Ends::kFoot);
  NamedCase out;
  const auto place = static_cast<std::size_t>(draw.whole(1, static_cast<int>(kNamedParts)));
  if (effect == "soft_part") {
    out.place = place, out.size = draw.uniform(0.4, 0.8);
    bar.scale_part(place, out.size);
  } else if (effect == "added_mass") {
    const double share = draw.uniform(0.04, 0.15);  // unit of the effect: 0.05 of the shaft
    out.place = place, out.size = share / 0.05;
    bar.add_mass(node_of(place), share);
  } else if (effect == "support_turning") {
    const double flexibility = draw.uniform(0.05, 0.4);
    out.size = flexibility / 0.1;
    bar.add_turning(flexibility);
  } else if (effect == "support_yielding") {
    const double flexibility = draw.log_uniform(5e-4, 4e-3);
    out.size = flexibility / 0.1;
    bar.release(0, 1.0 / flexibility);
  } else if (effect == "spring_stiffness") {
    const double stiffness = draw.uniform(5.0, 20.0);
    const auto at = static_cast<std::size_t>(draw.whole(3, 5));
    out.size = drawn_ratio(draw);
    tower.guys.push_back({static_cast<double>(at) / static_cast<double>(kNamedParts), stiffness});
    bar.add_spring(node_of(at), false, out.size * stiffness);
  } else {  // weight_softening: in units of 0.2 of the declared weight
    // A weight of 7.84 E I / L^2 buckles the cantilever (Timoshenko & Gere 1961); scaled by mass in units of gravity.
    const double weight = draw.uniform(0.5, 1.2), factor = draw.uniform(2.0, 4.0);
    const double heavy = weight / core::kStandardGravity_m_s2;  // kg/m: E I stays 1, so frequencies only change scale
    tower.gravity = true, tower.mass_per_m_kg = heavy;
    out.size = (factor - 1.0) / 0.2;
    bar.add_weight(factor * weight);
  }
  const auto nodes = bar.look(draw.whole(5, 8));
  out.truth = bar.matrices();
  out.declared = declare(make_tower(tower, bar_sights(nodes, true)), kMostNamedModes);
  return out;
}

NamedCase draw_beam(const std::string& effect, Draw& draw) {
  constexpr double kClamp = 1e9;  // stiffness of a clamped end
  Beam beam;
  beam.spans = {{1.0, 1.0, 1.0, kNamedParts}};
  beam.supports.resize(2);
  TrueBar bar(TrueBar::Ends::kHinges);
  NamedCase out;
  const int end = draw.whole(0, 1);
  const auto end_node = end == 0 ? std::size_t{0} : kNamedElements;
  if (effect == "soft_part") {
    out.place = static_cast<std::size_t>(draw.whole(1, static_cast<int>(kNamedParts)));
    out.size = draw.uniform(0.4, 0.8);
    bar.scale_part(out.place, out.size);
  } else if (effect == "added_mass") {
    const auto inner = static_cast<std::size_t>(draw.whole(1, static_cast<int>(kNamedParts) - 1));
    const double share = draw.uniform(0.04, 0.15);
    out.place = inner + 1, out.size = share / 0.05;  // the first place is the first support
    bar.add_mass(node_of(inner), share);
  } else if (effect == "support_yielding") {
    const double flexibility = draw.log_uniform(3e-4, 2e-3);
    out.place = static_cast<std::size_t>(end) + 1, out.size = flexibility / 0.1;
    bar.release(end_node, 1.0 / flexibility);
  } else if (effect == "support_restraint") {
    out.place = static_cast<std::size_t>(end) + 1, out.size = draw.uniform(0.5, 5.0);
    bar.add_spring(end_node, true, out.size);
  } else if (effect == "support_turning") {
    for (auto& support : beam.supports) support.rotation = Connection::rigid();
    const double flexibility = draw.uniform(0.03, 0.3);
    out.place = static_cast<std::size_t>(end) + 1, out.size = flexibility / 0.1;
    bar.add_spring(end_node, true, 1.0 / flexibility);
    bar.add_spring(end == 0 ? kNamedElements : 0, true, kClamp);
  } else if (effect == "spring_stiffness") {
    const double stiffness = draw.uniform(50.0, 200.0);
    beam.supports[static_cast<std::size_t>(end)].displacement = Connection::spring(stiffness);
    out.size = drawn_ratio(draw);
    bar.release(end_node, out.size * stiffness);
  } else {  // axial_force, in units of 0.1 of Euler's load
    const double share = draw.uniform(0.0, 1.0) < 0.5 ? -draw.uniform(0.1, 0.5) : draw.uniform(0.15, 1.0);
    out.size = share / 0.1;
    bar.add_tension(share * kEuler);
  }
  const auto nodes = bar.look(draw.whole(5, 8));
  out.truth = bar.matrices();
  out.declared = declare(make_beam(beam, bar_sights(nodes, false)), kMostNamedModes);
  return out;
}

// A short stiff hanger: bending is a thousandth to a two-hundredth of tension times length squared. No sag.
NamedCase draw_cable(const std::string& effect, Draw& draw) {
  const double tension = draw.log_uniform(200.0, 1000.0);
  Cable cable;
  cable.length_m = 1.0, cable.mass_per_m_kg = 1.0, cable.tension_n = tension, cable.ei_nm2 = 1.0;
  cable.tension_prior = 0.0, cable.ei_prior = 0.0;
  TrueBar bar(TrueBar::Ends::kHinges);
  NamedCase out;
  bool known = false;
  double force = tension;
  if (effect == "axial_force") {  // in units of a tenth of the declared tension
    const double share = draw.sign() * draw.uniform(0.05, 0.3);
    out.size = share / 0.1, force *= 1.0 + share, known = true;
  } else if (effect == "added_mass") {
    const auto place = static_cast<std::size_t>(draw.whole(1, 3));
    const double share = draw.uniform(0.04, 0.15);
    out.place = place, out.size = share / 0.05;
    bar.add_mass(place * kNamedElements / 4, share);
  } else if (effect == "soft_part") {  // the bending stiffness
    out.size = drawn_ratio(draw), known = true;
    for (std::size_t i = 1; i <= kNamedParts; ++i) bar.scale_part(i, out.size);
  } else {  // support_restraint, in units of sqrt(T E I)
    const int end = draw.whole(0, 1);
    out.place = static_cast<std::size_t>(end) + 1, out.size = draw.uniform(0.5, 4.0);
    bar.add_spring(end == 0 ? 0 : kNamedElements, true, out.size * std::sqrt(tension));
  }
  bar.add_tension(force);
  const auto nodes = bar.look(draw.whole(5, 8));
  out.truth = bar.matrices();
  out.declared = declare(make_cable(cable, bar_sights(nodes, false)), kMostNamedModes);
  if (known) out.declared.stiffness_over_mass_per_s2 = 1.0;
  return out;
}

}  // namespace tools
