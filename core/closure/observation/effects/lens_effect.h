#pragma once

#include <Eigen/Core>

#include "core/closure/observation/kinds/constant_effect.h"

namespace core::closure {

// x_d = x (1 + k1 r^2) + 2 p1 x y + p2 (r^2 + 2 x^2), y_d = y (1 + k1 r^2) + p1 (r^2 + 2 y^2) + 2 p2 x y (Brown 1971).
struct LensCoefficients {
  double k1 = 0.0, p1 = 0.0, p2 = 0.0;
};

// Removes the distortion from all positions, by fixed-point iteration.
void undo_lens(const LensCoefficients& lens, const CorrectionView& view, Eigen::MatrixXd& positions);

// A subset of these coefficients; corrected in flight together with those of the other lens effects.
class LensEffect : public PositionEffect, private InFlightCorrection {
 public:
  [[nodiscard]] CorrectionStage stage() const final { return CorrectionStage::kLens; }
  void remove(const Eigen::VectorXd& values, const CorrectionView& view, Eigen::MatrixXd& positions) const final {
    undo_lens(coefficients(values), view, positions);
  }
  [[nodiscard]] const InFlightCorrection* in_flight() const final { return this; }

 protected:
  [[nodiscard]] virtual LensCoefficients coefficients(const Eigen::VectorXd& values) const = 0;

 private:
  void add_to(RunCorrection& correction, const std::vector<ParameterValue>& parameters,
              const CameraModel& camera) const final;
};

}  // namespace core::closure
