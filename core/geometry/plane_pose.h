#pragma once

#include <Eigen/Dense>
#include <cstdint>
#include <optional>
#include <span>

#include "core/geometry/camera_model.h"

namespace core {

// A place in the structure's plane, in the coordinates of the survey; x and y are perpendicular, of either handedness.
struct PlanePlace {
  double x_mm = 0.0, y_mm = 0.0;
};

struct PlaneCorrespondence {
  Vector2 ideal_px;  // undistorted (CameraModel::undistort)
  PlanePlace place;
};

// Pose of the structure's plane: place (x, y) -> rotation * (x, y, 0) + translation_mm in camera axes (right, down,
// forward). Pixels are ideal ones throughout: the lens is not applied. A plain value; any thread.
struct PlanePose {
  CameraModel camera;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_mm{0.0, 0.0, 1.0};
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();  // of a rotation about the camera's
                                                                                 // axes (rad), then of the translation
                                                                                 // (mm)
  double rms_px = 0.0;      // distance between given and predicted pixels
  double chi_square = 0.0;  // for the stated sigma_px

  // nullopt: the place is behind the camera, or the ray does not meet the plane.
  [[nodiscard]] std::optional<Vector2> project(const PlanePlace& place) const noexcept;
  [[nodiscard]] std::optional<PlanePlace> place_at(const Vector2& ideal_px) const noexcept;

  [[nodiscard]] Eigen::Vector3d normal() const noexcept;  // unit, towards the camera
  [[nodiscard]] double distance_mm() const noexcept;      // from the camera's centre, along the normal

  // d(px)/d(mm): columns for x and y of the plane, rows for u and v. An image motion (du, dv) px at `place` is
  // jacobian^-1 (du, dv) mm in the plane.
  [[nodiscard]] Eigen::Matrix2d px_per_mm(const PlanePlace& place) const noexcept;
  // Length in the plane of an image motion of one pixel along the unit vector `direction`.
  [[nodiscard]] double mm_per_px(const PlanePlace& place, const Vector2& direction) const noexcept;

  // Angle between the plane's normal and the optical axis: 0 = frontal view, one scale everywhere.
  [[nodiscard]] double obliqueness_deg() const noexcept;
  // Standard deviation of the obliqueness; if the angle is smaller, that of the tilt in its least certain direction.
  [[nodiscard]] double obliqueness_sigma_deg() const noexcept;
};

enum class PlaneStatus : std::uint8_t { kOk, kNotCalibrated, kTooFew, kCollinear, kNoFit };

struct PlanePoseFit {
  PlaneStatus status = PlaneStatus::kNoFit;
  PlanePose pose;
  // The second solution of a plane seen from afar (tilted the other way), if the points contradict it by less than 11.8
  // in chi square (three standard deviations of two tilts): the pose is then ambiguous.
  std::optional<PlanePose> other;
};

// Needs at least four points, not collinear: homography (direct linear transformation, Hartley & Zisserman 2003, 4.1),
// pose from it (Zhang 2000, 3.1), Gauss-Newton on the reprojection error; the second start mirrors the depths about the
// points' centre (Schweighofer & Pinz 2006). sigma_px: of a pixel, per axis; if the residual is larger, the covariance
// is scaled by it. Status kNoFit: the points contradict each other, or are behind the camera.
[[nodiscard]] PlanePoseFit fit_plane_pose(std::span<const PlaneCorrespondence> points, const CameraModel& camera,
                                          double sigma_px);

}  // namespace core
