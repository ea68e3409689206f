#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"

namespace core::structure {
namespace {

// Columns of the ground storey softer or stiffer than declared: another length or fixity, or flexible feet.
class GroundStorey : public StructuralEffect {
 public:
  std::string_view name() const override { return "ground_storey"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame&) const override {
    return {{"stiffness_ratio", "1", 1.0, {0.7, 1.4}, 0.02, 50.0}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override { return needs_storeys(declared, 2); }
  void apply(std::span<const double> p, const DeclaredFrame&, ShearFrame& frame) const override {
    frame.stiffness_per_s2.front() *= p[0];
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame&, const ShearFrame&) const override {
    return outside(p[0], 0.2, 5.0, "a stiffness ratio");
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_ground_storey() { return std::make_unique<GroundStorey>(); }

}  // namespace core::structure
