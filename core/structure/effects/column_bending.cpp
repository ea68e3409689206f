#include "core/structure/effects/catalogue.h"
#include "core/structure/effects/plausibility.h"

namespace core::structure {
namespace {

// Axial deformation of the outer columns: the frame bends as a whole, in series with its shear (Timoshenko).
class ColumnBending : public StructuralEffect {
 public:
  std::string_view name() const override { return "column_bending"; }
  std::vector<EffectParameter> parameters(const DeclaredFrame&) const override {
    return {{"bending_flexibility", "1", 0.0, {0.0005, 0.01}, 0.0, 10.0}};
  }
  std::optional<Obstacle> obstacle(const DeclaredFrame& declared) const override { return needs_storeys(declared, 2); }
  void apply(std::span<const double> p, const DeclaredFrame&, ShearFrame& frame) const override {
    frame.bending_flexibility = p[0];
  }
  std::string implausible(std::span<const double> p, const DeclaredFrame&, const ShearFrame&) const override {
    if (!(p[0] > 0.0)) return "it would have to stiffen";
    return outside(p[0], 0.0, 0.1, "a flexibility");
  }
};

}  // namespace

std::unique_ptr<StructuralEffect> make_column_bending() { return std::make_unique<ColumnBending>(); }

}  // namespace core::structure
