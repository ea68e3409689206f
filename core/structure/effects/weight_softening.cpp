#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// The weight above softens more or less than declared: more mass, or a taller structure.
std::unique_ptr<StructuralEffect> make_weight_softening() {
  return std::make_unique<RoleEffect>("weight_softening", RoleEffect::Form{Role::kGravity,
                                                                           "change",
                                                                           "scale",
                                                                           false,
                                                                           {1.0, 5.0},
                                                                           -5.0,
                                                                           200.0,
                                                                           "the model has no weight that softens",
                                                                           "declare a tower with gravity: true"});
}

}  // namespace core::structure
