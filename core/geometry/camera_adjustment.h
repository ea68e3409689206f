#pragma once

#include <Eigen/Dense>
#include <vector>

#include "core/geometry/camera_fit.h"

namespace core {

// Pose of a board: board point p (mm) -> rotation * p + translation_mm in camera axes (right, down, forward).
struct BoardPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_mm = Eigen::Vector3d::Zero();
};

// Bundle adjustment of one camera and the poses of its boards: Gauss-Newton with step halving on the reprojection
// error. The poses are eliminated view by view (Schur complement), so the cost of a step is dominated by the sums.
class CameraAdjustment {
 public:
  CameraAdjustment(const ChessBoard& board, std::vector<BoardView> views, const CameraModel& start);

  void set_pose(std::size_t i_view, const BoardPose& pose) { poses_[i_view] = pose; }
  [[nodiscard]] const BoardPose& pose(std::size_t i_view) const { return poses_[i_view]; }
  [[nodiscard]] const CameraModel& camera() const noexcept { return camera_; }

  // Fits fx fy cx cy, the first `n_coefficients` and all poses. False if the parameters cannot be distinguished.
  bool solve(int n_coefficients);

  // Standard deviations after solve().
  [[nodiscard]] const std::vector<double>& sigma() const noexcept { return sigma_; }
  [[nodiscard]] double condition() const noexcept { return condition_; }
  [[nodiscard]] double rms_px() const;
  [[nodiscard]] double corner_sigma_px() const;
  [[nodiscard]] BoardView residuals(std::size_t i_view) const;

 private:
  struct Normal;  // normal equations of all views
  struct View;    // of one view
  [[nodiscard]] Normal sum_up() const;
  void add_corner(std::size_t i_view, std::size_t i_corner, View& view, Normal& normal) const;
  [[nodiscard]] double cost() const;
  void move(const Normal& normal, const Eigen::VectorXd& camera_step, double share);
  void take_sigma(const Normal& normal);

  ChessBoard board_;
  std::vector<BoardView> views_;
  std::vector<BoardPose> poses_;
  CameraModel camera_;
  int n_parameters_ = 4;  // of the camera
  std::vector<double> sigma_;
  double condition_ = 0.0;
};

}  // namespace core
