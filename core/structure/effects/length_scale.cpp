#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/role_effect.h"

namespace core::structure {
namespace {

// All lengths are wrong by one factor: the scale of a drawing, or feet for metres. Sections, springs, forces and point
// masses stay, so that it is more than a common factor of all frequencies where there are such.
class LengthScale : public RoleEffect {
 public:
  LengthScale()
      : RoleEffect("length_scale", Form{Role::kLength,
                                        "length_ratio",
                                        "1",
                                        true,
                                        {0.97, 1.03},
                                        0.4,
                                        2.5,
                                        "the model's matrices hold no lengths",
                                        "declare a beam, tower, cable or frame2d"}) {}
  [[nodiscard]] std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override {
    if (!declared.model || declared.model->kind() == "shear_frame")
      return Obstacle{"heights of storeys enter by their stiffness only", "stiffness_scale states the common factor"};
    if (auto words = RoleEffect::obstacle(declared)) return words;
    if (declared.stiffness_over_mass_per_s2) return std::nullopt;
    return Obstacle{"a common factor of all frequencies, which stiffness over mass absorbs",
                    "declare stiffness: known, from a section and a material"};
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_length_scale() { return std::make_unique<LengthScale>(); }

}  // namespace core::structure
