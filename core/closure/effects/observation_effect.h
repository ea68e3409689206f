#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/observation/frame_model.h"

namespace core::closure {

// What a parametric correction may look at.
struct CorrectionView {
  const ObservationRecord& record;
  const Eigen::MatrixXd& predicted_px;  // 2 points x frames: where the points are in the raw image, as the model has it
};

// One effect that the observation level knows. A field is an amplitude per frame on a pattern over the image; a global
// effect is a few constants of the whole record.
struct ObservationEffect {
  enum class Form { kField, kGlobal, kReadout, kLine };

  std::string name;
  Form form = Form::kField;
  std::vector<std::string> parameters;
  std::string unit;
  std::vector<double> waves_per_px;  // of parameters that multiply a wave over the image: an uncertain place blurs it
  double per_unit = 1.0;             // printed value = internal value * per_unit
  double plausible = 0.0;            // largest magnitude of an internal value
  bool of_tracker = false;           // an error of the tracker's: the points are elsewhere than it says
  double step = 0.0;                 // internal, for derivatives: small against what can be seen
  Eigen::Vector3d turn =
      Eigen::Vector3d::Zero();  // of the camera per internal unit, where the field is its first order
  // Field: px per internal unit, 2 points long.
  Eigen::VectorXd (*field)(const PointGeometry&) = nullptr;
  // Global: takes the effect of these values out of positions (2 points x frames, px).
  void (*correct)(const Eigen::VectorXd& values, const CorrectionView&, Eigen::MatrixXd& positions) = nullptr;
};

}  // namespace core::closure
