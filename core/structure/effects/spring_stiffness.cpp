#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// A declared spring (soil, pier, guy) softer or stiffer than declared.
std::unique_ptr<StructuralEffect> make_spring_stiffness() {
  return std::make_unique<RoleEffect>("spring_stiffness",
                                      RoleEffect::Form{Role::kSpring,
                                                       "stiffness_ratio",
                                                       "1",
                                                       true,
                                                       {0.6, 1.7},
                                                       0.01,
                                                       100.0,
                                                       "no spring is declared",
                                                       "declare supports or guys with their stiffness"});
}

}  // namespace core::structure
