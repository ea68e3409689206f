#include "core/geometry/slow_rotation.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "core/types/constants.h"

namespace core {

Vector2 SlowRotation::turned(const Vector2& keyframe, double late_s) const noexcept {
  const Eigen::Vector3d now = turn_ * Eigen::Vector3d(keyframe.u / fx_, keyframe.v / fy_, 1.0);
  const Eigen::Vector3d ray = now + late_s * rate_rad_s_.cross(now);
  return {fx_ * ray.x() / ray.z(), fy_ * ray.y() / ray.z()};
}

void SlowRotation::add(const RestingMotion& motion, const Eigen::Matrix3d& shown, double dt_s) noexcept {
  const Eigen::Vector3d left =
      shown.inverse() * Eigen::Vector3d(motion.moved_px.u / fx_, motion.moved_px.v / fy_, motion.turn_rad);
  if (!left.allFinite()) return;
  const Eigen::Vector3d whole = pole_[1] + left;
  const double share = 1.0 - std::exp(-kTwoPi * kSlow_hz * dt_s);
  pole_[0] += share * (whole - pole_[0]);
  const Eigen::Vector3d step = share * (pole_[0] - pole_[1]);
  pole_[1] += step;
  rate_rad_s_ = step / dt_s;
  const double angle = pole_[1].norm();
  turn_ = angle > 0.0 ? Eigen::AngleAxisd(angle, pole_[1] / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
}

}  // namespace core
