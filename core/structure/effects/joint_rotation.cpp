#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"

namespace core::structure {
namespace {

// Floors rotate with the ends of the columns: storeys are softer, and neighbouring storeys are coupled.
class JointRotation : public StructuralEffect {
 public:
  std::string_view name() const override { return "joint_rotation"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame&) const override {
    return {{"joint_flexibility", "1", 0.0, {0.02, 0.3}, 0.0, 100.0}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override { return needs_storeys(declared, 2); }
  void apply(std::span<const double> p, const DeclaredFrame&, ShearFrame& frame) const override {
    frame.joint_flexibility = p[0];
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame&, const ShearFrame&) const override {
    if (!(p[0] > 0.0)) return "it would have to stiffen";
    return outside(p[0], 0.0, 3.0, "a flexibility");
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_joint_rotation() { return std::make_unique<JointRotation>(); }

}  // namespace core::structure
