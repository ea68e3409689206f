#pragma once

#include <memory>
#include <vector>

#include "core/structure/kinds/connection.h"
#include "core/structure/structural_model.h"

namespace core::structure {

// A taut cable along x that moves along z: a string with bending stiffness and, for motion in the plane of its weight,
// the small sag of Irvine (Irvine & Caughey 1974): a motion that lengthens the parabola is restrained by
// (E A / L_e) (m g cos(slope) / T)^2 (integral of w)^2, L_e = L (1 + (m g L cos(slope) / T)^2 / 8).
struct Cable {
  double length_m = 0.0;  // of the chord
  double mass_per_m_kg = 0.0;
  double tension_n = 0.0;      // best guess: the parameter that is fitted
  double tension_prior = 0.3;  // relative standard deviation of the guess
  double ei_nm2 = 0.0, ei_prior = 0.0;
  double ea_n = 0.0;                             // 0: no sag
  double slope_deg = 0.0;                        // of the chord against the horizontal
  Connection end_rotation = Connection::free();  // of both ends
};

// Throws std::invalid_argument with value, range and remedy.
[[nodiscard]] std::unique_ptr<StructuralModel> make_cable(const Cable& cable, std::vector<Sight> sights);

}  // namespace core::structure
