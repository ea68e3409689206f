#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/types/closure_result.h"

namespace core::closure {

// Departure of a filmed clock from a constant offset: columns added to the predicted readings, in s.
class ClockEffect {
 public:
  ClockEffect() = default;
  ClockEffect(const ClockEffect&) = delete;
  ClockEffect& operator=(const ClockEffect&) = delete;
  virtual ~ClockEffect() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  // Nonlinear parameters, estimated from the residuals (s) of the present model at the readings in the training data;
  // may be empty.
  [[nodiscard]] virtual Eigen::VectorXd place(const Eigen::VectorXd& /*frame*/, const Eigen::VectorXd& /*residual_s*/,
                                              const std::vector<char>& /*seen*/) const {
    return {};
  }
  // One column per linear parameter at any frames; `last` = the record's last frame.
  [[nodiscard]] virtual Eigen::MatrixXd columns(const Eigen::VectorXd& frame, double last,
                                                const Eigen::VectorXd& place) const = 0;
  // Names, units and values for these coefficients at this declared rate.
  [[nodiscard]] virtual std::vector<ParameterValue> parameters(const Eigen::VectorXd& coefficients,
                                                               const Eigen::VectorXd& place, double rate_hz,
                                                               double last) const = 0;
  [[nodiscard]] virtual std::string implausible(const Eigen::VectorXd& /*coefficients*/, double /*rate_hz*/) const {
    return {};
  }
};

}  // namespace core::closure
