#include "core/geometry/slow_rotation.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/types/constants.h"

namespace core {

// A rotation w moves the ray (x, y, 1) by w x (x, y, 1), seen in the image; its third row is the curl there.
SlowRotation::SlowRotation(double fx, double fy, const Vector2& centre) : fx_(fx), fy_(fy) {
  const double x = centre.u / fx, y = centre.v / fy;
  Eigen::Matrix3d shown;
  shown << -x * y, 1.0 + x * x, -y, -1.0 - y * y, x * y, x, 0.5 * x, 0.5 * y, 1.0;
  rotation_of_motion_ = shown.inverse();
}

Vector2 SlowRotation::undone(const Vector2& position, const Vector2& keyframe) const noexcept {
  const Eigen::Vector3d ray = turn_ * Eigen::Vector3d(keyframe.u / fx_, keyframe.v / fy_, 1.0);
  return {position.u + keyframe.u - fx_ * ray.x() / ray.z(), position.v + keyframe.v - fy_ * ray.y() / ray.z()};
}

void SlowRotation::add(const RestingMotion& motion, double dt_s) noexcept {
  const Eigen::Vector3d left =
      rotation_of_motion_ * Eigen::Vector3d(motion.moved_px.u / fx_, motion.moved_px.v / fy_, motion.turn_rad);
  const Eigen::Vector3d whole = pole_[1] + left;
  const double share = 1.0 - std::exp(-kTwoPi * kSlow_hz * dt_s);
  pole_[0] += share * (whole - pole_[0]);
  pole_[1] += share * (pole_[0] - pole_[1]);
  const double angle = pole_[1].norm();
  turn_ = angle > 0.0 ? Eigen::AngleAxisd(angle, pole_[1] / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
}

}  // namespace core
