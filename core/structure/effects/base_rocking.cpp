#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"

namespace core::structure {
namespace {

// Rotation of the foundation, on soil, a shaking table or a flexible joint.
class BaseRocking : public StructuralEffect {
 public:
  std::string_view name() const override { return "base_rocking"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame&) const override {
    return {{"rocking_flexibility", "1", 0.0, {0.001, 0.02}, 0.0, 10.0}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override { return needs_storeys(declared, 2); }
  void apply(std::span<const double> p, const DeclaredFrame&, ShearFrame& frame) const override {
    frame.rocking_flexibility = p[0];
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame&, const ShearFrame&) const override {
    if (!(p[0] > 0.0)) return "it would have to stiffen";
    return outside(p[0], 0.0, 0.5, "a flexibility");
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_base_rocking() { return std::make_unique<BaseRocking>(); }

}  // namespace core::structure
