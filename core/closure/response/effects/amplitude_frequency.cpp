#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

// The frequency depends on the amplitude: a parabola in the logarithm of the amplitude, valid over decades of a decay
// (friction in joints, softening, hardening).
class AmplitudeFrequency final : public DecayEffect {
 public:
  [[nodiscard]] std::string name() const override { return "amplitude_dependent_frequency"; }
  [[nodiscard]] std::size_t n_parameters() const override { return 2; }
  [[nodiscard]] double start() const override { return 0.3; }
  void apply(const double* p, double x, DecayRates& rates) const override {
    rates.frequency_hz += p[0] * x + p[1] * x * x;
  }
  [[nodiscard]] std::vector<ParameterValue> describe(const double* p) const override {
    return {{"frequency_slope", "Hz per e-fold", p[0], {}}, {"frequency_curvature", "Hz per e-fold^2", p[1], {}}};
  }
};

}  // namespace

std::unique_ptr<DecayEffect> make_amplitude_frequency() { return std::make_unique<AmplitudeFrequency>(); }

}  // namespace core::closure
