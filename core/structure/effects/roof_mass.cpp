#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"

namespace core::structure {
namespace {

// The uppermost floor is lighter or heavier than declared: no storey above it, or equipment on it.
class RoofMass : public StructuralEffect {
 public:
  std::string_view name() const override { return "roof_mass"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame&) const override {
    return {{"mass_ratio", "1", 1.0, {0.7, 1.4}, 0.05, 20.0}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override { return needs_storeys(declared, 2); }
  void apply(std::span<const double> p, const DeclaredFrame&, ShearFrame& frame) const override {
    frame.mass.back() *= p[0];
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame&, const ShearFrame&) const override {
    return outside(p[0], 0.3, 3.0, "a mass ratio");
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_roof_mass() { return std::make_unique<RoofMass>(); }

}  // namespace core::structure
