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
  mesh.add_spring(node, motion, mesh.add_parameter(std::move(p)), Law::kPower);
}

void add_possible_mass(LineMesh& mesh, std::size_t node, double most, const std::string& name,
                       const std::string& place) {
  ModelParameter p;
  p.name = name, p.unit = "kg", p.place = place;
  p.role = Role::kAddedMass;
  p.high = most, p.scale = 0.05 * most;
  mesh.add_mass(node, 1.0, mesh.add_parameter(std::move(p)));
}

ModelParameter shear_parameter(const char* unit, double scale) {
  ModelParameter p;
  p.name = "shear_flexibility", p.unit = unit, p.role = Role::kShearFlexibility;
  p.high = 100.0 * scale, p.scale = scale;
  return p;
}

ModelParameter rigid_end_parameter(const std::string& name, const std::string& place, double most_m) {
  ModelParameter p;
  p.name = name, p.unit = "m", p.place = place, p.role = Role::kRigidEnd;
  p.high = most_m, p.scale = 0.2 * most_m;
  return p;
}

ModelParameter length_parameter() {
  ModelParameter p;
  p.name = "length", p.unit = "1", p.role = Role::kLength;
  p.value = 1.0, p.low = 0.3, p.high = 3.0, p.scale = 0.02;
  return p;
}

int shear_functions_for(std::size_t n_bars) noexcept {
  return std::clamp(static_cast<int>(24 / std::max<std::size_t>(n_bars, 1)), 3, 14);
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
