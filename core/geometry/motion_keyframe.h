#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/geometry/motion_equations.h"

namespace core {

// One point of the keyframe. (x, y, 1) = its ray, undistorted; q = 1 / depth, 0 for far away.
struct KeyframePoint {
  double x = 0.0, y = 0.0;
  double inverse_depth = 0.0;  // 1/mm
  double readout_share = 0.0;  // readout fraction of the raw row
  double sigma_px = 0.03;
  std::uint16_t region = 0;
};

// The keyframe as the equations of camera_motion.h use it: rays, middles c, columns of the regions' own motions.
struct MotionKeyframe {
  std::vector<MotionPoint> points;
  std::vector<MotionRegion> regions;
  Eigen::Vector3d middle = Eigen::Vector3d::UnitZ();  // ray to the centre of the structure
};
// distance_mm: to the structure, the scale of plausible translations.
[[nodiscard]] MotionKeyframe motion_keyframe(const std::vector<KeyframePoint>& points,
                                             const std::vector<KeyframeRegion>& regions, double distance_mm);

}  // namespace core
