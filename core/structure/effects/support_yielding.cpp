#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// A support declared as rigid that yields: soil, pier, bearing.
std::unique_ptr<StructuralEffect> make_support_yielding() {
  return std::make_unique<RoleEffect>("support_yielding", RoleEffect::Form{Role::kSupportYielding,
                                                                           "flexibility",
                                                                           "scale",
                                                                           false,
                                                                           {0.1, 1.0},
                                                                           0.0,
                                                                           1000.0,
                                                                           "no support is declared as rigid",
                                                                           "it is a spring: see spring_stiffness"});
}

}  // namespace core::structure
