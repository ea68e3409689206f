#pragma once

#include <Eigen/Core>
#include <array>

#include "core/types/vector2.h"

namespace core {

// What a static region shows in one frame beyond turned(): its motion since the keyframe and its rotation in the image.
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
// taken for a rotation would otherwise scale the structure's motion by its place in the image (0.3 %, 0.3 m at 20 m).
//
// One thread; does not allocate. A frame without add() keeps the rotation.
class SlowRotation {
 public:
  static constexpr double kSlow_hz = 1.0;

  SlowRotation(double fx_px, double fy_px) noexcept : fx_(fx_px), fy_(fy_px) {}

  // Where the rotation puts a place of the keyframe; undistorted px from the principal point. late_s: from the instant
  // of the static region to that of the point's row. The camera turns on meanwhile: what is removed of a gust would
  // otherwise lack the delays that the gust itself has.
  [[nodiscard]] Vector2 turned(const Vector2& keyframe, double late_s) const noexcept;
  // shown: shown_rotation() of the region after its removal. Points that do not determine the rotation are ignored.
  void add(const RestingMotion& motion, const Eigen::Matrix3d& shown, double dt_s) noexcept;
  [[nodiscard]] const Eigen::Vector3d& rotation_rad() const noexcept { return pole_[1]; }

 private:
  double fx_, fy_;
  std::array<Eigen::Vector3d, 2> pole_{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // rad
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d rate_rad_s_ = Eigen::Vector3d::Zero();
};

}  // namespace core
