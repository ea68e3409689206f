#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// An axial force that is not declared, or another one: compression softens, tension stiffens.
std::unique_ptr<StructuralEffect> make_axial_force() {
  return std::make_unique<RoleEffect>("axial_force", RoleEffect::Form{Role::kAxialForce,
                                                                      "force",
                                                                      "scale",
                                                                      false,
                                                                      {-1.0, 1.0},
                                                                      -9.0,
                                                                      500.0,
                                                                      "the model has no axial force",
                                                                      "declare a beam or members with axial_n"});
}

}  // namespace core::structure
