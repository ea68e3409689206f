#pragma once

#include <Eigen/Core>

#include "core/closure/observation/held_out.h"
#include "core/closure/observation/lens_coefficients.h"
#include "core/closure/observation/observation_record.h"
#include "core/closure/observation/point_motion_model.h"

namespace core::closure {

// Inputs of a correction of positions.
struct CorrectionView {
  const ObservationRecord& record;
  const Eigen::MatrixXd& predicted_px;  // 2 points x frames: positions in the raw image predicted by the model
  LensCoefficients lens;                // of all adopted effects
};

// Read access for effects to the state of a fit. Valid until the fit changes.
struct FitView {
  const ObservationRecord& record;
  const PointMotionModel& model;
  const HeldOut& held_out;
  const Eigen::MatrixXd& predicted_px;  // as in CorrectionView
  double readout_frames = 0.0;          // declared and added
  double sigma_px = 0.0;                // of the points, rms
  LensCoefficients lens = {};           // of all adopted effects

  [[nodiscard]] CorrectionView correction() const noexcept { return {record, predicted_px, lens}; }
};

}  // namespace core::closure
