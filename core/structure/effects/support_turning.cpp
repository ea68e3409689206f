#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// A support declared as clamped that turns.
std::unique_ptr<StructuralEffect> make_support_turning() {
  return std::make_unique<RoleEffect>("support_turning", RoleEffect::Form{Role::kSupportTurning,
                                                                          "flexibility",
                                                                          "scale",
                                                                          false,
                                                                          {0.3, 3.0},
                                                                          0.0,
                                                                          1000.0,
                                                                          "no support is declared as clamped",
                                                                          "it is a spring: see spring_stiffness"});
}

}  // namespace core::structure
