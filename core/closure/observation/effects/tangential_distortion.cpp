#include "core/closure/observation/effects/catalogue.h"
#include "core/closure/observation/effects/lens_effect.h"

namespace core::closure {
namespace {

class TangentialDistortion final : public LensEffect {
 public:
  [[nodiscard]] EffectId id() const override { return {"tangential_distortion"}; }
  [[nodiscard]] std::string name() const override { return "tangential distortion"; }
  [[nodiscard]] std::vector<Parameter> constants() const override { return {{"p1"}, {"p2"}}; }
  [[nodiscard]] double most() const override { return 0.1; }
  [[nodiscard]] double step() const override { return 1e-4; }

 protected:
  [[nodiscard]] LensCoefficients coefficients(const Eigen::VectorXd& values) const override {
    return {.p1 = values(0), .p2 = values(1)};
  }
};

}  // namespace

std::unique_ptr<ObservationEffect> make_tangential_distortion() { return std::make_unique<TangentialDistortion>(); }

}  // namespace core::closure
