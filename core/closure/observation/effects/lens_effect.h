#pragma once

#include "core/closure/observation/kinds/constant_effect.h"

namespace core::closure {

// Some of the lens's coefficients. Those of all adopted lens effects are undone in one (ObservationFit), and corrected
// in flight together.
class LensEffect : public PositionEffect, private InFlightCorrection {
 public:
  [[nodiscard]] LensCoefficients lens(const Eigen::VectorXd& values) const final { return coefficients(values); }
  [[nodiscard]] CorrectionStage stage() const final { return CorrectionStage::kLens; }
  void correct(CorrectionStage /*at*/, const Eigen::VectorXd& /*values*/, const CorrectionView& /*view*/,
               Eigen::MatrixXd& /*positions*/) const final {}
  void remove(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) const final;
  [[nodiscard]] const InFlightCorrection* in_flight() const final { return this; }

 protected:
  [[nodiscard]] virtual LensCoefficients coefficients(const Eigen::VectorXd& values) const = 0;
  [[nodiscard]] CorrectionView beside(const Eigen::VectorXd& values, CorrectionView view) const final;

 private:
  void add_to(RunCorrection& correction, const std::vector<ParameterValue>& parameters,
              const CameraModel& camera) const final;
};

}  // namespace core::closure
