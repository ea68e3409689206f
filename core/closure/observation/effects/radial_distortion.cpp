#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/lens_effect.h"

namespace core::closure {
namespace {

class RadialDistortion final : public LensEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"radial_distortion"}; }
  [[nodiscard]] std::string name() const override { return "radial distortion"; }
  [[nodiscard]] std::vector<Parameter> constants() const override { return {{"k1"}}; }
  [[nodiscard]] double most() const override { return 1.0; }
  [[nodiscard]] double step() const override { return 1e-3; }

 protected:
  [[nodiscard]] LensCoefficients coefficients(const Eigen::VectorXd& values) const override {
    return {.k1 = values(0)};
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_radial_distortion() { return std::make_unique<RadialDistortion>(); }

}  // namespace core::closure
