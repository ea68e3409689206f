#include "core/simulation/projection.h"

#include <Eigen/Geometry>

namespace core::simulation {

Eigen::Matrix3d attitude(double pitch_rad, double yaw_rad, double roll_rad) {
  return (Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

ImagePoint project(const CameraParameters& camera, const CameraPose& pose, double x_mm, double y_mm,
                   double z_mm) noexcept {
  const Eigen::Vector3d world(x_mm - pose.x_mm, y_mm - pose.y_mm, z_mm - pose.z_mm);
  const Eigen::Vector3d seen = pose.attitude.transpose() * world;
  return {camera.cx_px + camera.alpha_px * seen.x() / seen.z(), camera.cy_px + camera.alpha_px * seen.y() / seen.z()};
}

PlanePoint back_project(const CameraParameters& camera, const CameraPose& pose, ImagePoint image,
                        double depth_mm) noexcept {
  const Eigen::Vector3d ray = pose.attitude * Eigen::Vector3d((image.u_px - camera.cx_px) / camera.alpha_px,
                                                              (image.v_px - camera.cy_px) / camera.alpha_px, 1.0);
  const double length = (depth_mm - pose.z_mm) / ray.z();
  return {pose.x_mm + length * ray.x(), pose.y_mm + length * ray.y()};
}

}  // namespace core::simulation
