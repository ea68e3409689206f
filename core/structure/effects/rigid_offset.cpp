#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {

// A member that begins at the face of its joint, not at its node: one end is rigid over a length along the member.
std::unique_ptr<StructuralEffect> make_rigid_offset() {
  return std::make_unique<RoleEffect>("rigid_offset", RoleEffect::Form{Role::kRigidEnd,
                                                                       "length",
                                                                       "scale",
                                                                       false,
                                                                       {1.5},
                                                                       0.0,
                                                                       5.0,
                                                                       "the model has no ends of members",
                                                                       "declare a beam or a frame2d"});
}

}  // namespace core::structure
