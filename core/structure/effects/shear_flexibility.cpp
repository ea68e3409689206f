#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// Cross-sections that shear, in series with bending (Timoshenko): lattices, sandwiches, short thick bars.
std::unique_ptr<StructuralEffect> make_shear_flexibility() {
  return std::make_unique<RoleEffect>("shear_flexibility",
                                      RoleEffect::Form{Role::kShearFlexibility,
                                                       "flexibility",
                                                       "scale",
                                                       false,
                                                       {0.3, 3.0},
                                                       0.0,
                                                       100.0,
                                                       "the model does not bend, or its shear stiffness is declared",
                                                       "leave shear_n out of a beam, tower or frame2d"});
}

}  // namespace core::structure
