#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/derotated_flow.h"

namespace core::closure {

// Rotation of the image that a model leaves in one frame pair, radians (camera axes), and its information. A rotation
// that a camera translation would explain as well carries no information.
struct ResidualRotation {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

// Most likely rotation near zero, by Levenberg-Marquardt; the pair's translation is fitted with it.
[[nodiscard]] ResidualRotation residual_rotation(std::vector<DerotatedFlow> flows, const DerotatedFlowModel& model,
                                                 Eigen::Vector3d shift_px);

}  // namespace core::closure
