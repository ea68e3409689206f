#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/geometry/gyro_readout.h"

namespace core {

struct GyroStart {
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();
  double offset_s = 0.0;  // of the frames' middle rows
};

// Axes and clock offset for which the gyro's rotation matches the image's (Wahba's problem by SVD, over a grid of
// offsets). Means are removed first: a steady camera translation resembles a steady rotation, as does the gyro's bias.
// Axes aligned with the image's are preferred if they fit about as well, because sensors are mounted so. Throws
// std::invalid_argument if the camera hardly rotates.
[[nodiscard]] GyroStart start_from_turns(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                                         const GyroReadoutConfig& config, double focal_px);

}  // namespace core
