#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

// The frames have another constant rate than declared.
class ClockRate final : public ClockEffect {
 public:
  [[nodiscard]] std::string name() const override { return "clock_rate"; }
  [[nodiscard]] Eigen::MatrixXd columns(const Eigen::VectorXd& frame, double /*last*/,
                                        const Eigen::VectorXd& /*place*/) const override {
    return frame;
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const Eigen::VectorXd& coefficients,
                                                       const Eigen::VectorXd& /*place*/, double rate_hz,
                                                       double /*last*/) const override {
    return {{"rate", "Hz", 1.0 / (1.0 / rate_hz + coefficients(0)), {}}};
  }
  [[nodiscard]] std::string implausible(const Eigen::VectorXd& coefficients, double rate_hz) const override {
    return coefficients(0) * rate_hz > -0.95 ? "" : "the frames would stand still or run backward";
  }
};

}  // namespace

std::unique_ptr<ClockEffect> make_clock_rate() { return std::make_unique<ClockRate>(); }

}  // namespace core::closure
