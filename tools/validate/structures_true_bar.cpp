// Matrices of the simulator's cantilever and deck, changed by parts, for the figure of named effects.
#include <cmath>

#include "core/simulation/structure/beam_builders.h"
#include "tools/validate/structures_elements.h"
#include "tools/validate/structures_named.h"

namespace tools {
namespace {

using core::structure::Sight;
using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kElementsInPart = kNamedElements / kNamedParts;

}  // namespace

TrueBar::TrueBar(Ends ends, double length_m)
    : ends_(ends), length_m_(length_m), element_m_(length_m / static_cast<double>(kNamedElements)) {
  using namespace core::simulation;
  const ModalDamping damping{{0.01}};
  const StructureModel model =
      ends == Ends::kFoot
          ? cantilever({1e3 * length_m, static_cast<int>(kNamedElements), 1.0, 1.0, 0.0}, damping)
          : bridge_deck({1e3 * length_m, static_cast<int>(kNamedElements) - 1, 1, 1.0, 1.0, BridgeDeck::Ends::kSimple},
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
  for (std::size_t e = (number - 1) * kElementsInPart; e < number * kElementsInPart; ++e)
    add(out, e, bending_element(element_m_));
  return out;
}

void TrueBar::scale_part(std::size_t number, double ratio) { out_.stiffness += (ratio - 1.0) * part(number); }

void TrueBar::stiffen(std::size_t first, std::size_t count) {
  constexpr double kRigid = 1e4;
  for (std::size_t e = first; e < first + count; ++e)
    add(out_.stiffness, e, (kRigid - 1.0) * bending_element(element_m_));
}

void TrueBar::shear(double flexibility) {
  const auto in_one = static_cast<std::size_t>(kShearNodes - 1);
  const ElementMatrices one = shear_element(element_m_ * static_cast<double>(in_one), 1.0, 1.0 / flexibility, 1.0);
  out_.stiffness.setZero(), out_.mass.setZero();
  for (std::size_t first = 0; first < kNamedElements; first += in_one) {
    const auto at = [&](Index i) { return dof(first + static_cast<std::size_t>(i / 2), i % 2 == 1); };
    for (Index i = 0; i < 2 * kShearNodes; ++i) {
      for (Index j = 0; j < 2 * kShearNodes; ++j) {
        if (at(i) < 0 || at(j) < 0) continue;
        out_.stiffness(at(i), at(j)) += one.stiffness(i, j), out_.mass(at(i), at(j)) += one.mass(i, j);
      }
    }
  }
}

void TrueBar::add_mass(std::size_t node, double share) { out_.mass(dof(node, false), dof(node, false)) += share; }

void TrueBar::add_tension(double newton) {
  for (std::size_t e = 0; e < kNamedElements; ++e) add(out_.stiffness, e, newton * tension_element(element_m_));
}

void TrueBar::add_weight(double newton) {
  for (std::size_t e = 0; e < kNamedElements; ++e) {
    const double middle = (static_cast<double>(e) + 0.5) * element_m_;
    add(out_.stiffness, e, -newton * (1.0 - middle) * tension_element(element_m_));
  }
}

void TrueBar::add_spring(std::size_t node, bool turns, double stiffness) {
  out_.stiffness(dof(node, turns), dof(node, turns)) += stiffness;
}

void TrueBar::add_turning(double flexibility) {
  VectorXd rigid = VectorXd::Zero(out_.stiffness.rows());
  for (std::size_t node = 1; node <= kNamedElements; ++node) {
    rigid(dof(node, false)) = static_cast<double>(node) * element_m_;
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
  const double own_mass = (length_m_ - rigid.dot(out_.mass * rigid) - 2.0 * rigid.dot(mass)) / ends;
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
    const double x = static_cast<double>(node) * (1.0 / static_cast<double>(kNamedElements));
    out.push_back({"r" + std::to_string(out.size() + 1), upright ? Eigen::Vector3d(0, 0, x) : Eigen::Vector3d(x, 0, 0),
                   upright ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ()});
  }
  return out;
}

}  // namespace tools
