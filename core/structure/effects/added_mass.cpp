#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// A mass that is not declared, at one place: equipment, water, ice.
std::unique_ptr<StructuralEffect> make_added_mass() {
  return std::make_unique<RoleEffect>("added_mass", RoleEffect::Form{Role::kAddedMass,
                                                                     "mass",
                                                                     "scale",
                                                                     false,
                                                                     {0.5, 3.0},
                                                                     0.0,
                                                                     40.0,
                                                                     "the model has no places for a mass",
                                                                     "declare a kind with places"});
}

}  // namespace core::structure
