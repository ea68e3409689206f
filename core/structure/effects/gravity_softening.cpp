#include <sstream>

#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"
#include "core/types/constants.h"

namespace core::structure {
namespace {

constexpr double kGravityMmPerS2 = 1e3 * kStandardGravity_m_s2;
constexpr double kMostStability = 0.3;  // Eurocode 8, 4.4.2.2
// The deflected column is a curve, not a straight line: up to 6/5 of the weight is effective (consistent geometric
// stiffness). Heights from drawings are accurate to a few percent.
constexpr double kHeightLow = 0.75, kHeightHigh = 1.10;

// The weight of the floors above increases the lean of a storey (P-delta). The parameter is g / h if relative masses
// are known: the storey height then follows without further data.
class GravitySoftening : public StructuralEffect {
 public:
  std::string_view name() const override { return "gravity_softening"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame& declared) const override {
    const double start = declared.storey_height_mm ? kGravityMmPerS2 / *declared.storey_height_mm : 0.0;
    return {{"gravity_over_height", "1/s^2", 0.0, {start, 1.0, 30.0}, 0.0, kGravityMmPerS2}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override { return needs_storeys(declared, 2); }
  void apply(std::span<const double> p, const DeclaredFrame&, ShearFrame& frame) const override {
    frame.gravity_over_height_per_s2 = p[0];
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame& declared,
                          const ShearFrame& frame) const override {
    if (!(p[0] > 0.0)) return "it would have to stiffen";
    const double height_mm = kGravityMmPerS2 / p[0];
    if (declared.storey_height_mm) {
      const double height_ratio = height_mm / *declared.storey_height_mm;
      if (std::string words = outside(height_ratio, kHeightLow, kHeightHigh, "a storey height over the declared one");
          !words.empty())
        return words;
    }
    return outside(stability_coefficient(frame), 0.0, kMostStability,
                   "a weight over height relative to the ground storey's stiffness");
  }
  std::string meaning(std::span<const double> p, const DeclaredFrame&) const override {
    if (!(p[0] > 0.0)) return {};
    std::ostringstream text;
    text.precision(3);
    text << "implies a storey height of " << kGravityMmPerS2 / p[0] << " mm";
    return text.str();
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_gravity_softening() { return std::make_unique<GravitySoftening>(); }

}  // namespace core::structure
