#include "core/simulation/camera/projection.h"

#include <Eigen/Geometry>

#include "core/simulation/camera/lens.h"

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
  const Ray ray = distort(camera.lens, {seen.x() / seen.z(), seen.y() / seen.z()});
  const double alpha_px = camera.alpha_px * pose.zoom;
  return {camera.cx_px + alpha_px * ray.x, camera.cy_px + alpha_px * ray.y};
}

PlanePoint back_project(const CameraParameters& camera, const CameraPose& pose, ImagePoint image,
                        double depth_mm) noexcept {
  const double alpha_px = camera.alpha_px * pose.zoom;
  const Ray seen =
      undistort(camera.lens, {(image.u_px - camera.cx_px) / alpha_px, (image.v_px - camera.cy_px) / alpha_px});
  const Eigen::Vector3d ray = pose.attitude * Eigen::Vector3d(seen.x, seen.y, 1.0);
  const double length = (depth_mm - pose.z_mm) / ray.z();
  return {pose.x_mm + length * ray.x(), pose.y_mm + length * ray.y()};
}

double readout_share(const CameraParameters& camera, ImagePoint image) noexcept {
  switch (camera.readout_direction) {
    case core::ReadoutDirection::kDown:
      return image.v_px / camera.height_px;
    case core::ReadoutDirection::kUp:
      return -image.v_px / camera.height_px;
    case core::ReadoutDirection::kRight:
      return image.u_px / camera.width_px;
    case core::ReadoutDirection::kLeft:
      return -image.u_px / camera.width_px;
  }
  return 0.0;
}

}  // namespace core::simulation
