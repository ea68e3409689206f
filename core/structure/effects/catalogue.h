#pragma once

#include <memory>

#include "core/structure/structural_effect.h"
#include "core/types/effect_catalogue.h"

// The effects of the structure level, one line each, in the order in which they are tested. The file effects/NAME.cpp
// defines make_NAME().
#define HOVERMODAL_STRUCTURAL_EFFECTS(EFFECT) \
  EFFECT(ground_storey)                       \
  EFFECT(gravity_softening)                   \
  EFFECT(joint_rotation)                      \
  EFFECT(base_rocking)                        \
  EFFECT(roof_mass)                           \
  EFFECT(column_bending)                      \
  EFFECT(stiffness_scale)                     \
  EFFECT(soft_part)                           \
  EFFECT(added_mass)                          \
  EFFECT(support_turning)                     \
  EFFECT(support_yielding)                    \
  EFFECT(support_restraint)                   \
  EFFECT(spring_stiffness)                    \
  EFFECT(axial_force)                         \
  EFFECT(weight_softening)                    \
  EFFECT(shear_flexibility)                   \
  EFFECT(rigid_offset)                        \
  EFFECT(coupling)                            \
  EFFECT(temperature)                         \
  EFFECT(length_scale)                        \
  EFFECT(integrator)                          \
  EFFECT(clock_rate)

namespace core::structure {

#define HOVERMODAL_DECLARE(name) [[nodiscard]] std::unique_ptr<StructuralEffect> make_##name();
HOVERMODAL_STRUCTURAL_EFFECTS(HOVERMODAL_DECLARE)
#undef HOVERMODAL_DECLARE

[[nodiscard]] const EffectList<StructuralEffect>& structural_effects();

}  // namespace core::structure
