#include "core/structure/kinds/connection.h"

#include <algorithm>
#include <sstream>

namespace core::structure {

void connect(LineMesh& mesh, std::size_t node, Motion motion, const Connection& connection, double typical,
             const std::string& name, const std::string& place, double prior) {
  const bool turns = motion == Motion::kTurn;
  const char* stiffness_unit = turns ? "N m/rad" : "N/m";
  ModelParameter p;
  p.name = name, p.place = place;
  if (connection.kind == Connection::Kind::kRigid) {
    p.name += "_flexibility", p.unit = turns ? "rad/(N m)" : "m/N";
    p.role = turns ? Role::kSupportTurning : Role::kSupportYielding;
    p.high = 1e3 / typical, p.scale = 0.1 / typical;
    const std::size_t parameter = mesh.add_parameter(std::move(p));
    mesh.add_spring(node, motion, parameter, Law::kReciprocal, kRigidFlexibility / typical);
    return;
  }
  if (connection.kind == Connection::Kind::kFree && !turns) return;
  p.name += "_stiffness", p.unit = stiffness_unit, p.role = Role::kSpring;
  p.value = connection.stiffness;
  p.high = 1e3 * std::max(typical, connection.stiffness);
  p.scale = connection.stiffness > 0.0 ? connection.stiffness : typical;
  p.prior_sigma = prior * connection.stiffness;
  mesh.add_spring(node, motion, mesh.add_parameter(std::move(p)), Law::kLinear);
}

void add_possible_mass(LineMesh& mesh, std::size_t node, double most, const std::string& name,
                       const std::string& place) {
  ModelParameter p;
  p.name = name, p.unit = "kg", p.place = place;
  p.role = Role::kAddedMass;
  p.high = most, p.scale = 0.05 * most;
  mesh.add_mass(node, 1.0, mesh.add_parameter(std::move(p)));
}

int bubbles_for(std::size_t n_bars) noexcept {
  return std::clamp(static_cast<int>(48 / std::max<std::size_t>(n_bars, 1)), 4, 22);
}

std::string place_text(double at_m) {
  std::ostringstream text;
  text.precision(4);
  text << at_m << " m";
  return text.str();
}

}  // namespace core::structure
