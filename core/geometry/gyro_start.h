#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/geometry/gyro_readout.h"

namespace core {

struct GyroStart {
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();
  double offset_s = 0.0;  // of the frames' middle lines
};

// Axes and clock offset at which the gyro turns as the picture does (Wahba's problem by SVD, over a grid of offsets).
// Means are taken away first: a steady shift of the camera looks like a steady turn, and the gyro's bias is one.
// Axes along the picture's are preferred where they do about as well: chips are mounted so.
// Throws std::invalid_argument: the camera hardly turns.
[[nodiscard]] GyroStart start_from_turns(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                                         const GyroReadoutConfig& config, double focal_px);

}  // namespace core
