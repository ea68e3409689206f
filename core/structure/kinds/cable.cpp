#include "core/structure/kinds/cable.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "core/structure/kinds/declared_value.h"
#include "core/types/constants.h"

namespace core::structure {
namespace {

constexpr std::size_t kCableParts = 4;  // a mass may sit between them
// Bending at a held end decays over sqrt(E I / T), a thousandth of the length: a bar of its own resolves it. Without it
// a tension is estimated up to 0.1 % too low.
constexpr double kEndBar = 10.0;
constexpr double kMostSag = 0.125;  // of the chord: beyond, the parabola is no longer small (Irvine)

void validate(const Cable& cable) {
  require_value(cable.length_m, 1e-2, 1e4, "length_m");
  require_value(cable.mass_per_m_kg, 1e-6, 1e6, "mass_per_m_kg");
  require_value(cable.tension_n, 1e-6, 1e12, "tension_n");
  require_value(cable.tension_prior, 0.0, 10.0, "tension_prior");
  require_value(cable.ei_nm2, 0.0, 1e15, "ei_nm2");
  require_value(cable.ea_n, 0.0, 1e15, "ea_n");
  require_value(cable.slope_deg, -90.0, 90.0, "slope_deg");
  const double sag = cable.mass_per_m_kg * kStandardGravity_m_s2 * cable.length_m / (8.0 * cable.tension_n);
  if (cable.ea_n > 0.0 && sag > kMostSag)
    refuse_declaration("tension_n: ", cable.tension_n, " N gives a sag of ", sag, " of the length: allowed up to ",
                       kMostSag, "; check tension and mass_per_m_kg");
}

ModelParameter tension_of(const Cable& cable) {
  ModelParameter p;
  p.name = "tension", p.unit = "N", p.role = Role::kAxialForce;
  p.value = cable.tension_n, p.low = 0.02 * cable.tension_n, p.high = 50.0 * cable.tension_n;
  p.scale = 0.1 * cable.tension_n, p.prior_sigma = cable.tension_prior * cable.tension_n;
  return p;
}

// Ends of bars: of the parts, and of the end bars where the cable bends. Shares of the length.
std::vector<double> bar_ends(const Cable& cable) {
  constexpr double kPart = 1.0 / static_cast<double>(kCableParts);
  std::vector<double> out;
  for (std::size_t i = 0; i <= kCableParts; ++i) out.push_back(kPart * static_cast<double>(i));
  const double end = kEndBar * std::sqrt(cable.ei_nm2 / cable.tension_n) / cable.length_m;
  if (end > 0.0 && end < 0.5 * kPart) {
    out.insert(out.begin() + 1, end);
    out.insert(out.end() - 1, 1.0 - end);
  }
  return out;
}

}  // namespace

std::unique_ptr<StructuralModel> make_cable(const Cable& cable, std::vector<Sight> sights) {
  validate(cable);
  LineMesh mesh(false, 12);
  std::vector<std::size_t> nodes;
  const std::vector<double> ends = bar_ends(cable);
  for (const double end : ends) {
    nodes.push_back(mesh.add_node(cable.length_m * end, 0.0));
    mesh.fix(nodes.back(), Motion::kX);
  }
  mesh.fix(nodes.front(), Motion::kZ);
  mesh.fix(nodes.back(), Motion::kZ);
  const std::size_t tension = mesh.add_parameter(tension_of(cable));
  Bar bar;
  bar.ei = 1.0, bar.mass_per_m = cable.mass_per_m_kg;
  ModelParameter bending;
  bending.name = "bending_stiffness", bending.unit = "N m^2", bending.role = Role::kPartStiffness;
  bending.value = cable.ei_nm2, bending.prior_sigma = cable.ei_prior * cable.ei_nm2;
  const double slender = cable.tension_n * cable.length_m * cable.length_m;
  bending.high = std::max(50.0 * cable.ei_nm2, slender), bending.scale = std::max(0.2 * cable.ei_nm2, 1e-4 * slender);
  const std::size_t ei = mesh.add_parameter(std::move(bending));
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const std::size_t number = mesh.add_bar(nodes[i], nodes[i + 1], bar, ei);
    mesh.add_tension(
        number, [](double) { return 1.0; }, tension);
  }
  for (const std::size_t end : {nodes.front(), nodes.back()})
    connect(mesh, end, Motion::kTurn, cable.end_rotation, std::sqrt(cable.tension_n * std::max(cable.ei_nm2, 1e-12)),
            end == nodes.front() ? "first_end_rotation" : "last_end_rotation",
            end == nodes.front() ? "first end" : "last end");
  const std::size_t inner = (nodes.size() - kCableParts + 1) / 2;  // first node between two parts
  for (std::size_t i = 0; i + 1 < kCableParts; ++i)
    add_possible_mass(mesh, nodes[inner + i], cable.length_m * cable.mass_per_m_kg, "mass_" + std::to_string(i + 1),
                      place_text(cable.length_m * ends[inner + i]));
  if (cable.ea_n > 0.0) {
    const double weight =
        cable.mass_per_m_kg * kStandardGravity_m_s2 * std::cos(cable.slope_deg * std::numbers::pi / 180);
    const double bow = weight * cable.length_m / cable.tension_n;
    const double stretched = cable.length_m * (1.0 + bow * bow / 8.0);
    mesh.add_uniform_restraint(cable.ea_n / stretched * weight * weight, tension, -2);
  }
  mesh.set_length(mesh.add_parameter(length_parameter()));
  return std::make_unique<AffineModel>(mesh.build("cable", std::move(sights), 0.5 * cable.length_m));
}

}  // namespace core::structure
