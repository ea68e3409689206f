#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// One part (element, storey, group of members) softer than declared: damage, a crack, a loose joint; or stiffer.
std::unique_ptr<StructuralEffect> make_soft_part() {
  return std::make_unique<RoleEffect>("soft_part", RoleEffect::Form{Role::kPartStiffness,
                                                                    "stiffness_ratio",
                                                                    "1",
                                                                    true,
                                                                    {0.9, 0.6},
                                                                    0.05,
                                                                    5.0,
                                                                    "the model has no parts",
                                                                    "declare parts or groups"});
}

}  // namespace core::structure
