#pragma once

#include <Eigen/Core>
#include <array>

#include "core/types/vector2.h"

namespace core {

// What a static region shows in one frame after undone(): its motion since the keyframe and its rotation in the image.
struct RestingMotion {
  Vector2 moved_px;
  double turn_rad = 0.0;
};

// The camera's rotation slower than kSlow_hz: two poles on the rotation that a static region shows. Its translation
// looks like a rotation and is followed as one. A rotation of several degrees moves points by their place in the image,
// which no linear input of the identification expresses; what is faster, and the noise of the region's points there,
// stays in the points, in all regions alike.
//
// A point is moved back by what the rotation does to its place in the keyframe, not to its present place: a translation
// taken for a rotation would otherwise scale the structure's motion by its place in the image (0.3 % for 0.3 m at 20
// m).
//
// One thread; does not allocate. A frame without add() keeps the rotation.
class SlowRotation {
 public:
  static constexpr double kSlow_hz = 1.0;

  // fx, fy: px; centre: of the region in the keyframe, px from the principal point.
  SlowRotation(double fx, double fy, const Vector2& centre);

  // The point without what the rotation does to its place in the keyframe; both undistorted px from the principal
  // point.
  [[nodiscard]] Vector2 undone(const Vector2& position, const Vector2& keyframe) const noexcept;
  void add(const RestingMotion& motion, double dt_s) noexcept;
  [[nodiscard]] const Eigen::Vector3d& rotation_rad() const noexcept { return pole_[1]; }

 private:
  double fx_, fy_;
  Eigen::Matrix3d rotation_of_motion_;  // from motion / focal length and rotation in the image
  std::array<Eigen::Vector3d, 2> pole_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // rad
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
};

}  // namespace core
