// Towers, beams and cables for the figure of named effects.
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "core/structure/kinds/beam.h"
#include "core/structure/kinds/cable.h"
#include "core/structure/kinds/tower.h"
#include "core/types/constants.h"
#include "tools/validate/structures_named.h"

namespace tools {
namespace {

using namespace core::structure;
constexpr double kEuler = std::numbers::pi * std::numbers::pi;  // Euler's load of the hinged bar

// Number of a part's end among the model's nodes, and the element node there.
std::size_t node_of(std::size_t part_end) { return part_end * (kNamedElements / kNamedParts); }

double drawn_ratio(Draw& draw) {
  return draw.uniform(0.0, 1.0) < 0.5 ? draw.uniform(0.4, 0.7) : draw.uniform(1.5, 2.5);
}

}  // namespace

double drawn_length(Draw& draw) { return 1.0 + draw.sign() * draw.uniform(0.02, 0.1); }

void warm(NamedCase& out, Draw& draw) { out.size = draw.sign() * draw.uniform(10.0, 30.0); }

DeclaredFrame declared_as(std::unique_ptr<StructuralModel> model, const std::string& effect) {
  DeclaredFrame out = declare(std::move(model), kMostNamedModes);
  if (effect == "temperature") out.temperature = TemperatureLaw{kWarmPerKelvin, 0.0};
  // A rigid end shortens a clamped bar: but for shapes that is a common factor, as the other two are.
  const bool is_factor =
      effect == "temperature" || effect == "length_scale" || (effect == "rigid_offset" && out.model->kind() == "beam");
  if (is_factor) out.stiffness_over_mass_per_s2 = 1.0;
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
  } else if (effect == "shear_flexibility") {
    const double flexibility = draw.log_uniform(2e-3, 2e-2);
    out.size = flexibility / 0.01;
    bar.shear(flexibility);
  } else if (effect == "temperature") {
    warm(out, draw);
    for (std::size_t i = 1; i <= kNamedParts; ++i) bar.scale_part(i, 1.0 + kWarmPerKelvin * out.size);
  } else if (effect == "length_scale") {  // a guy's stiffness does not change with it
    const double stiffness = draw.uniform(5.0, 20.0);
    const auto at = static_cast<std::size_t>(draw.whole(3, 5));
    out.size = drawn_length(draw);
    tower.guys.push_back({static_cast<double>(at) / static_cast<double>(kNamedParts), stiffness});
    bar = TrueBar(TrueBar::Ends::kFoot, out.size);
    bar.add_spring(node_of(at), false, stiffness);
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
  out.declared = declared_as(make_tower(tower, bar_sights(nodes, true)), effect);
  return out;
}

NamedCase draw_beam(const std::string& effect, Draw& draw) {
  constexpr double kClamp = 1e9;  // stiffness of a clamped end
  Beam beam;
  beam.spans = {{1.0, 1.0, 1.0, kNamedParts}};
  beam.supports.resize(2);
  TrueBar bar(TrueBar::Ends::kHinges);
  NamedCase out;
  std::optional<TemperatureLaw> law;
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
  } else if (effect == "shear_flexibility") {
    const double flexibility = draw.log_uniform(2e-3, 2e-2);
    out.size = flexibility / 0.01;
    bar.shear(flexibility);
  } else if (effect == "rigid_offset") {  // in units of an element; both ends clamped
    for (auto& support : beam.supports) support.rotation = Connection::rigid();
    const int count = draw.whole(2, 4);
    out.place = static_cast<std::size_t>(end) + 1, out.size = count;
    for (const std::size_t node : {std::size_t{0}, kNamedElements}) bar.add_spring(node, true, kClamp);
    const auto n = static_cast<std::size_t>(count);
    bar.stiffen(end == 0 ? 0 : kNamedElements - n, n);
  } else if (effect == "temperature") {  // between abutments: a rise compresses
    constexpr double kPerKelvin = -5e-4, kEulerPerKelvin = -0.02;
    out.size = draw.sign() * draw.uniform(8.0, 25.0);
    for (std::size_t i = 1; i <= kNamedParts; ++i) bar.scale_part(i, 1.0 + kPerKelvin * out.size);
    bar.add_tension(out.size * kEulerPerKelvin * kEuler);
    law = TemperatureLaw{kPerKelvin, kEulerPerKelvin * kEuler};
  } else if (effect == "length_scale") {  // a support's stiffness does not change with it
    const double stiffness = draw.uniform(50.0, 200.0);
    beam.supports[static_cast<std::size_t>(end)].displacement = Connection::spring(stiffness);
    out.size = drawn_length(draw);
    bar = TrueBar(TrueBar::Ends::kHinges, out.size);
    bar.release(end_node, stiffness);
  } else {  // axial_force, in units of 0.1 of Euler's load
    const double share = draw.uniform(0.0, 1.0) < 0.5 ? -draw.uniform(0.1, 0.5) : draw.uniform(0.15, 1.0);
    out.size = share / 0.1;
    bar.add_tension(share * kEuler);
  }
  const auto nodes = bar.look(draw.whole(5, 8));
  out.truth = bar.matrices();
  out.declared = declared_as(make_beam(beam, bar_sights(nodes, false)), effect);
  out.declared.temperature = law;
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
  std::optional<TemperatureLaw> law;
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
  } else if (effect == "temperature") {
    constexpr double kPerKelvin = -5e-4, kTensionPerKelvin = -6e-3;
    out.size = draw.sign() * draw.uniform(8.0, 30.0), force *= 1.0 + kTensionPerKelvin * out.size, known = true;
    for (std::size_t i = 1; i <= kNamedParts; ++i) bar.scale_part(i, 1.0 + kPerKelvin * out.size);
    law = TemperatureLaw{kPerKelvin, kTensionPerKelvin * tension};
  } else if (effect == "length_scale") {
    out.size = drawn_length(draw), known = true;
    bar = TrueBar(TrueBar::Ends::kHinges, out.size);
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
  out.declared.temperature = law;
  return out;
}

}  // namespace tools
