#include "core/structure/effects/catalogue.h"

namespace core::structure {
namespace {

// A fast or slow clock multiplies all frequencies by one factor, as stiffness over mass does: frequencies alone cannot
// distinguish the two.
class ClockRate : public StructuralEffect {
 public:
  std::string_view name() const override { return "clock_rate"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame&) const override { return {}; }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override {
    return Obstacle{declared.stiffness_over_mass_per_s2
                        ? "a common factor of all frequencies: a wrong stiffness or mass gives the same"
                        : "a common factor of all frequencies, which stiffness over mass absorbs",
                    "film a clock, or measure one mode with a second instrument"};
  }
  std::string implausible(std::span<const double>, const DeclaredFrame&, const ShearFrame&) const override {
    return {};
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_clock_rate() { return std::make_unique<ClockRate>(); }

}  // namespace core::structure
