#pragma once

#include <Eigen/Core>
#include <span>

namespace core {

// Derotated optical flow of a static point: its motion between two frames after the camera's rotation has been removed.
// Camera translation t moves a static point at x (px from the principal point) by
//     d (1 + delta),    d = (t_x - t_z x / f, t_y - t_z y / f),    1 + delta = mean depth over the point's depth
// t in px: f times the translation over the mean depth. Depths are unknown: delta ~ N(0, 1). So along d, the epipolar
// line, a point has the variance sigma^2 + |d|^2, across it sigma^2; a far point, or one near the focus of expansion,
// is informative along both axes. Student's t of three degrees for moving objects and false tracks.

struct DerotatedFlow {
  Eigen::Vector2d at_px = Eigen::Vector2d::Zero();  // position predicted by the rotation alone
  Eigen::Vector2d flow_px = Eigen::Vector2d::Zero();
};

struct DerotatedFlowModel {
  double focal_px = 1.0;
  double sigma_px = 1.0;
};

// Minus log likelihood of one point, and its derivatives by d.
struct DerotatedFlowTerm {
  double cost = 0.0;
  double across_px = 0.0;  // distance from the epipolar line
  double weight = 0.0;     // robust weight, at most 5/3; decreases with the distance
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();       // of d
  Eigen::Matrix2d flow_information = Eigen::Matrix2d::Zero();  // of the flow, for fixed d
};

[[nodiscard]] Eigen::Matrix<double, 2, 3> shift_effect(const DerotatedFlow& point,
                                                       double focal_px) noexcept;  // d(d) / d(t)
// How a change of d moves the point from where it was seen: along the epipolar line unchanged, across it by the line's
// rotation, times the point's own flow along it over |d|. The depth that this shows distinguishes a rotation from a
// translation.
[[nodiscard]] Eigen::Matrix2d depth_lever(const DerotatedFlow& point, const Eigen::Vector2d& d_px) noexcept;
[[nodiscard]] DerotatedFlowTerm judge(const DerotatedFlow& point, const Eigen::Vector3d& shift_px,
                                      const DerotatedFlowModel& model) noexcept;
[[nodiscard]] double cost(std::span<const DerotatedFlow> points, const Eigen::Vector3d& shift_px,
                          const DerotatedFlowModel& model) noexcept;
// Maximum-likelihood translation, started at the given one; returns its cost.
double fit_shift(std::span<const DerotatedFlow> points, const DerotatedFlowModel& model,
                 Eigen::Vector3d& shift_px) noexcept;

}  // namespace core
