#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// A spring that is not declared, between two structures or two parts of one: a walkway, a cable, a closed gap.
std::unique_ptr<StructuralEffect> make_coupling() {
  return std::make_unique<RoleEffect>("coupling",
                                      RoleEffect::Form{Role::kCoupling,
                                                       "stiffness",
                                                       "scale",
                                                       false,
                                                       {0.3, 5.0},
                                                       0.0,
                                                       1000.0,
                                                       "no places that may be coupled are declared",
                                                       "declare both structures in one frame2d, with couplings"});
}

}  // namespace core::structure
