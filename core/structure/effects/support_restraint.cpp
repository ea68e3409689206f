#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// A support declared as a hinge that resists turning.
std::unique_ptr<StructuralEffect> make_support_restraint() {
  return std::make_unique<RoleEffect>("support_restraint", RoleEffect::Form{Role::kSpring,
                                                                            "stiffness",
                                                                            "scale",
                                                                            false,
                                                                            {0.5, 5.0},
                                                                            0.0,
                                                                            1000.0,
                                                                            "no support is declared as a hinge",
                                                                            "it is clamped: see support_turning"});
}

}  // namespace core::structure
