#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/geometry/rest_flow.h"

namespace core::closure {

// Rotation of the picture that a model leaves in one frame pair, radians (camera axes), and what the pair tells of it:
// along the rest a shift of the camera would do as well.
struct RemainingTurn {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

// The most likely one near none, by Levenberg-Marquardt; the pair's shift is fitted with it.
[[nodiscard]] RemainingTurn remaining_turn(std::vector<RestFlow> flows, const RestFlowModel& model,
                                           Eigen::Vector3d shift_px);

}  // namespace core::closure
