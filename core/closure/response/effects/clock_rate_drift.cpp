#include <cmath>

#include "core/closure/response/effects/catalogue.h"

namespace core::closure {
namespace {

constexpr double kMost = 0.2;  // change of the interval over the record, relative

// The interval between frames changes linearly over the record: a parabola without offset and slope.
class ClockRateDrift final : public ClockEffect {
 public:
  [[nodiscard]] std::string name() const override { return "clock_rate_drift"; }
  [[nodiscard]] Eigen::MatrixXd columns(const Eigen::VectorXd& frame, double last,
                                        const Eigen::VectorXd& /*place*/) const override {
    const Eigen::ArrayXd x = frame.array() / last;
    return (0.5 * last * (x.square() - x)).matrix();
  }
  [[nodiscard]] std::vector<ParameterValue> parameters(const Eigen::VectorXd& coefficients,
                                                       const Eigen::VectorXd& /*place*/, double rate_hz,
                                                       double /*last*/) const override {
    return {{"change_of_interval", "%", 100.0 * coefficients(0) * rate_hz, {}}};
  }
  [[nodiscard]] std::string implausible(const Eigen::VectorXd& coefficients, double rate_hz) const override {
    return std::abs(coefficients(0)) * rate_hz < kMost ? "" : "the interval would change by more than a fifth";
  }
};

}  // namespace

std::unique_ptr<ClockEffect> make_clock_rate_drift() { return std::make_unique<ClockRateDrift>(); }

}  // namespace core::closure
