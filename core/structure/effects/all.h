#pragma once

#include <memory>

#include "core/structure/structural_effect.h"

namespace core::structure {

[[nodiscard]] std::unique_ptr<StructuralEffect> make_ground_storey();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_gravity_softening();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_joint_rotation();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_base_rocking();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_roof_mass();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_column_bending();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_stiffness_scale();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_integrator();
[[nodiscard]] std::unique_ptr<StructuralEffect> make_clock_rate();

// What two numbers of a fit have to say: "1.93 lies outside 0.2 .. 5"; empty where it lies inside.
[[nodiscard]] std::string outside(double value, double low, double high, std::string_view what);
// Effects that change one storey against the others need others.
[[nodiscard]] std::optional<Obstacle> needs_storeys(const DeclaredFrame& declared, std::size_t n);

}  // namespace core::structure
