#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/lens_effect.h"

namespace core::closure {
namespace {

// The higher radial terms: what a strong lens has beside k1. Observable where points far from the principal point
// drift; confused with k1 where all points lie at one distance from it.
class LensDistortion final : public LensEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"lens_distortion"}; }
  [[nodiscard]] std::string name() const override { return "lens distortion"; }
  [[nodiscard]] std::vector<Parameter> constants() const override { return {{"k2"}, {"k3"}}; }
  [[nodiscard]] double most() const override { return 5.0; }
  [[nodiscard]] double step() const override { return 1e-2; }
  [[nodiscard]] bool refines(const EffectId& lower) const override { return lower.key == "radial_distortion"; }

 protected:
  [[nodiscard]] LensCoefficients coefficients(const Eigen::VectorXd& values) const override {
    return {.k2 = values(0), .k3 = values(1)};
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_lens_distortion() { return std::make_unique<LensDistortion>(); }

}  // namespace core::closure
