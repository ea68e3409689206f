#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

// The decay rate depends on the amplitude: its logarithm is a parabola in the logarithm of the amplitude (friction:
// slower decay of large motion; drag: faster decay).
class AmplitudeDamping final : public DecayEffect {
 public:
  [[nodiscard]] std::string name() const override { return "amplitude_dependent_damping"; }
  [[nodiscard]] std::size_t n_parameters() const override { return 2; }
  [[nodiscard]] double start() const override { return 0.15; }
  void apply(const double* p, double x, DecayRates& rates) const override { rates.log_rate += p[0] * x + p[1] * x * x; }
  [[nodiscard]] std::vector<ParameterValue> describe(const double* p) const override {
    return {{"damping_slope", "per e-fold", p[0], {}}, {"damping_curvature", "per e-fold^2", p[1], {}}};
  }
};

}  // namespace

std::unique_ptr<DecayEffect> make_amplitude_damping() { return std::make_unique<AmplitudeDamping>(); }

}  // namespace core::closure
