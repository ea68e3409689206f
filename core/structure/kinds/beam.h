#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/structure/kinds/connection.h"
#include "core/structure/structural_model.h"

namespace core::structure {

// A straight beam along x that moves along z: spans between supports or piers (Euler and Bernoulli; Timoshenko with
// shear_n; Blevins, Formulas for Natural Frequency and Mode Shape, 8).
struct Beam {
  struct Span {
    double length_m = 0.0, ei_nm2 = 0.0, mass_per_m_kg = 0.0;
    std::size_t parts = 1;  // equal lengths, each with a stiffness factor of its own
  };
  struct Support {
    Connection displacement = Connection::rigid(), rotation = Connection::free();
  };
  struct Mass {
    double at_m = 0.0, kg = 0.0;  // at the nearest end of a part
  };
  std::vector<Span> spans;
  std::vector<Support> supports;  // at the ends of the spans: one more than spans
  std::vector<Mass> masses;
  double axial_n = 0.0;                         // tension positive
  std::optional<double> shear_n;                // kappa G A: Timoshenko
  double rotary_per_m_kgm = 0.0;                // rotary inertia of the cross-section, with shear_n
  double spring_prior = 0.0, part_prior = 0.0;  // relative standard deviations of declared springs and parts
};

// Throws std::invalid_argument with value, range and remedy.
[[nodiscard]] std::unique_ptr<StructuralModel> make_beam(const Beam& beam, std::vector<Sight> sights);

}  // namespace core::structure
