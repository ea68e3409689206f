#include <cmath>

#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"

namespace core::structure {
namespace {

// Stiffness over mass differs from the declared value. If it was not declared, it is always fitted.
class StiffnessScale : public StructuralEffect {
 public:
  std::string_view name() const override { return "stiffness_scale"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame&) const override {
    return {{"stiffness_over_mass_ratio", "1", 1.0, {0.98, 1.02}, 0.05, 20.0}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override {
    if (declared.stiffness_over_mass_per_s2) return std::nullopt;
    return Obstacle{"stiffness over mass was not declared and is fitted from the beginning",
                    "declare stiffness_over_mass, from a drawing or a pull test"};
  }
  void apply(std::span<const double> p, const DeclaredFrame&, ShearFrame& frame) const override {
    for (double& k : frame.stiffness_per_s2) k *= p[0];
  }
  bool changes_frequencies() const override { return true; }
  double seen_hz(double frequency_hz, std::span<const double> p, const DeclaredFrame& declared) const override {
    return declared.model ? std::sqrt(p[0]) * frequency_hz : frequency_hz;
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame&, const ShearFrame&) const override {
    return outside(p[0], 0.3, 3.0, "a ratio of stiffness over mass");
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_stiffness_scale() { return std::make_unique<StiffnessScale>(); }

}  // namespace core::structure
