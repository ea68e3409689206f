#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/structure/kinds/connection.h"
#include "core/structure/structural_model.h"

namespace core::structure {

// A cantilever along z that moves along x: mast, chimney, tower; with guys as springs.
struct Tower {
  struct Guy {
    double at_m = 0.0, stiffness_n_per_m = 0.0;  // horizontal stiffness of all guys at that height
  };
  double height_m = 0.0;
  double ei_nm2 = 0.0, mass_per_m_kg = 0.0;  // at the foot
  // The diameter varies linearly to this ratio at the tip; EI varies as its ei_power, mass as its mass_power: 4 and 2
  // of a solid or similar section, 3 and 1 of a tube of constant wall.
  double diameter_ratio = 1.0, ei_power = 4.0, mass_power = 2.0;
  std::size_t parts = 1;  // equal heights, each with a stiffness factor of its own
  double tip_mass_kg = 0.0;
  std::vector<Guy> guys;
  Connection foot_displacement = Connection::rigid(), foot_rotation = Connection::rigid();
  std::optional<double> shear_n;  // kappa G A at the foot, varies as the mass: Timoshenko
  double rotary_per_m_kgm = 0.0;  // rotary inertia of the cross-section at the foot, with shear_n
  bool gravity = true;            // the weight above softens (compression)
  double spring_prior = 0.0, part_prior = 0.0;
};

// Throws std::invalid_argument with value, range and remedy.
[[nodiscard]] std::unique_ptr<StructuralModel> make_tower(const Tower& tower, std::vector<Sight> sights);

}  // namespace core::structure
