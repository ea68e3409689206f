#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/closure/observation/frame_model.h"

namespace core::closure {

// Inputs of a parametric correction.
struct CorrectionView {
  const ObservationRecord& record;
  const Eigen::MatrixXd& predicted_px;  // 2 points x frames: positions in the raw image predicted by the model
};

// One effect known to the observation level. A field has one amplitude per frame on a pattern over the image; a global
// effect has a few constants for the whole record.
struct ObservationEffect {
  enum class Form { kField, kGlobal, kReadout, kLine };

  std::string name;
  Form form = Form::kField;
  std::vector<std::string> parameters;
  std::string unit;
  std::vector<double> waves_per_px;  // of parameters that multiply a wave over the image: an uncertain place blurs it
  double per_unit = 1.0;             // printed value = internal value * per_unit
  double plausible = 0.0;            // largest magnitude of an internal value
  bool of_tracker = false;           // a tracking error: the points are elsewhere than measured
  double step = 0.0;                 // internal, for derivatives: small relative to what is observable
  Eigen::Vector3d turn =
      Eigen::Vector3d::Zero();  // of the camera per internal unit, where the field is its first order
  // Field: px per internal unit, 2 points long.
  Eigen::VectorXd (*field)(const PointGeometry&) = nullptr;
  // Global: removes the effect with these values from positions (2 points x frames, px).
  void (*correct)(const Eigen::VectorXd& values, const CorrectionView&, Eigen::MatrixXd& positions) = nullptr;
};

}  // namespace core::closure
