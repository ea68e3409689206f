#pragma once

#include <Eigen/Core>

#include "core/simulation/scene.h"

namespace core::simulation {

// Position and attitude of the camera. `attitude` maps camera axes to world axes; identity looks along +Z.
struct CameraPose {
  double x_mm = 0.0, y_mm = 0.0, z_mm = 0.0;
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();
  double zoom = 1.0;  // of the focal length
};

struct ImagePoint {
  double u_px = 0.0, v_px = 0.0;
};

struct PlanePoint {
  double x_mm = 0.0, y_mm = 0.0;
};

// Rotation first about X (pitch), then Y (yaw), then Z (roll).
[[nodiscard]] Eigen::Matrix3d attitude(double pitch_rad, double yaw_rad, double roll_rad);

// Full perspective projection of a world point through the lens, and its inverse on the plane Z = depth_mm.
[[nodiscard]] ImagePoint project(const CameraParameters& camera, const CameraPose& pose, double x_mm, double y_mm,
                                 double z_mm) noexcept;
[[nodiscard]] PlanePoint back_project(const CameraParameters& camera, const CameraPose& pose, ImagePoint image,
                                      double depth_mm) noexcept;

// Readout fraction of this pixel; row (column) 0 is at 0; directions up and left run to
// -1.
[[nodiscard]] double readout_share(const CameraParameters& camera, ImagePoint image) noexcept;

}  // namespace core::simulation
