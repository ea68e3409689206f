#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/geometry/gyro_readout.h"

namespace core {

struct GyroStart {
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();
  double offset_s = 0.0;  // of the frames' middle lines
};

// Axes and clock offset at which the gyro's rotation matches the image's (Wahba's problem by SVD, over a grid of
// offsets). Means are removed first: a steady translation of the camera resembles a steady rotation, as does the gyro's
// bias. Axes along the image's are preferred where they fit about as well, because chips are mounted so. Throws
// std::invalid_argument: the camera hardly rotates.
[[nodiscard]] GyroStart start_from_turns(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                                         const GyroReadoutConfig& config, double focal_px);

}  // namespace core
