#include "core/geometry/camera_adjustment.h"

#include <cmath>
#include <limits>
#include <utility>

namespace core {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using ByCamera = Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::ColMajor, 2, 12>;  // on the stack: one per corner

Eigen::Vector3d board_point(const ChessBoard& board, std::size_t i_corner) {
  const auto columns = static_cast<std::size_t>(board.columns);
  return {static_cast<double>(i_corner % columns) * board.square_mm,
          static_cast<double>(i_corner / columns) * board.square_mm, 0.0};
}

Eigen::Matrix3d rotation_by(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, w / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
}

Vector2 seen_minus_predicted(const CameraModel& camera, const Eigen::Vector3d& p, const Vector2& seen) {
  const LensBend at = bend(camera, p.x() / p.z(), p.y() / p.z());
  return {seen.u - camera.cx - camera.fx * at.x, seen.v - camera.cy - camera.fy * at.y};
}

}  // namespace

struct CameraAdjustment::View {
  Matrix6 hessian = Matrix6::Zero();
  Eigen::MatrixXd mixed;  // camera parameters x pose
  Vector6 gradient = Vector6::Zero();
};

struct CameraAdjustment::Normal {
  Eigen::MatrixXd hessian;
  Eigen::VectorXd gradient;
  std::vector<View> views;
};

CameraAdjustment::CameraAdjustment(const ChessBoard& board, std::vector<BoardView> views, const CameraModel& start)
    : board_(board), views_(std::move(views)), poses_(views_.size()), camera_(start) {}

BoardView CameraAdjustment::residuals(std::size_t i_view) const {
  BoardView out;
  const BoardPose& pose = poses_[i_view];
  for (std::size_t i = 0; i < views_[i_view].size(); ++i) {
    const Eigen::Vector3d p = pose.rotation * board_point(board_, i) + pose.translation_mm;
    out.push_back(seen_minus_predicted(camera_, p, views_[i_view][i]));
  }
  return out;
}

double CameraAdjustment::cost() const {
  double sum = 0.0;
  for (std::size_t i_view = 0; i_view < views_.size(); ++i_view) {
    for (const Vector2& r : residuals(i_view)) sum += r.u * r.u + r.v * r.v;
  }
  return sum;
}

double CameraAdjustment::rms_px() const {
  return std::sqrt(cost() / static_cast<double>(views_.size() * board_.n_corners()));
}

double CameraAdjustment::corner_sigma_px() const {
  const auto n_equations = static_cast<double>(2 * views_.size() * board_.n_corners());
  const double n_free = n_equations - n_parameters_ - 6.0 * static_cast<double>(views_.size());
  return n_free > 0.0 ? std::sqrt(cost() / n_free) : std::numeric_limits<double>::infinity();
}

// d(raw px) with respect to the camera's parameters, to a rotation w about the camera's axes and to a translation t of
// the board: dp = w x (R b) + t.
void CameraAdjustment::add_corner(std::size_t i_view, std::size_t i_corner, View& view, Normal& normal) const {
  const BoardPose& pose = poses_[i_view];
  const Eigen::Vector3d turned = pose.rotation * board_point(board_, i_corner);
  const Eigen::Vector3d p = turned + pose.translation_mm;
  const double x = p.x() / p.z();
  const double y = p.y() / p.z();
  const LensBend at = bend(camera_, x, y);
  Eigen::Matrix2d d_ray;
  d_ray << camera_.fx * at.dx_dx, camera_.fx * at.dx_dy, camera_.fy * at.dy_dx, camera_.fy * at.dy_dy;
  Eigen::Matrix<double, 2, 3> d_point;
  d_point << 1.0 / p.z(), 0.0, -x / p.z(), 0.0, 1.0 / p.z(), -y / p.z();
  const Eigen::Matrix<double, 2, 3> d_shift = d_ray * d_point;
  Eigen::Matrix<double, 2, 6> by_pose;
  for (int i = 0; i < 3; ++i) by_pose.col(i) = d_shift * Eigen::Vector3d::Unit(i).cross(turned);
  by_pose.rightCols<3>() = d_shift;
  ByCamera by_camera = ByCamera::Zero(2, n_parameters_);
  by_camera(0, 0) = at.x;
  by_camera(1, 1) = at.y;
  by_camera(0, 2) = by_camera(1, 3) = 1.0;
  for (int i = 4; i < n_parameters_; ++i) {
    constexpr double kStep = 0.5;  // exact: the models are linear in their coefficients (rational ones are not fitted)
    CameraModel more = camera_;
    more.distortion[static_cast<std::size_t>(i - 4)] += kStep;
    const LensBend there = bend(more, x, y);
    by_camera(0, i) = camera_.fx * (there.x - at.x) / kStep;
    by_camera(1, i) = camera_.fy * (there.y - at.y) / kStep;
  }
  const Vector2& seen = views_[i_view][i_corner];
  const Eigen::Vector2d r(seen.u - camera_.cx - camera_.fx * at.x, seen.v - camera_.cy - camera_.fy * at.y);
  normal.hessian += by_camera.transpose() * by_camera;
  normal.gradient += by_camera.transpose() * r;
  view.hessian += by_pose.transpose() * by_pose;
  view.mixed += by_camera.transpose() * by_pose;
  view.gradient += by_pose.transpose() * r;
}

// Normal equations after elimination of the poses.
CameraAdjustment::Normal CameraAdjustment::sum_up() const {
  Normal out;
  out.hessian = Eigen::MatrixXd::Zero(n_parameters_, n_parameters_);
  out.gradient = Eigen::VectorXd::Zero(n_parameters_);
  for (std::size_t i_view = 0; i_view < views_.size(); ++i_view) {
    View view;
    view.mixed = Eigen::MatrixXd::Zero(n_parameters_, 6);
    for (std::size_t i = 0; i < views_[i_view].size(); ++i) add_corner(i_view, i, view, out);
    const Eigen::LDLT<Matrix6> inverse(view.hessian);
    out.hessian -= view.mixed * inverse.solve(view.mixed.transpose());
    out.gradient -= view.mixed * inverse.solve(view.gradient);
    out.views.push_back(std::move(view));
  }
  return out;
}

void CameraAdjustment::move(const Normal& normal, const Eigen::VectorXd& camera_step, double share) {
  camera_.fx += share * camera_step(0);
  camera_.fy += share * camera_step(1);
  camera_.cx += share * camera_step(2);
  camera_.cy += share * camera_step(3);
  for (int i = 4; i < n_parameters_; ++i) camera_.distortion[static_cast<std::size_t>(i - 4)] += share * camera_step(i);
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const View& view = normal.views[i];
    const Vector6 step =
        Eigen::LDLT<Matrix6>(view.hessian).solve(view.gradient - view.mixed.transpose() * camera_step) * share;
    poses_[i].rotation = rotation_by(step.head<3>()) * poses_[i].rotation;
    poses_[i].translation_mm += step.tail<3>();
  }
}

bool CameraAdjustment::solve(int n_coefficients) {
  constexpr int kSteps = 50;
  constexpr int kHalvings = 8;
  constexpr double kLeastGain = 1e-10;
  n_parameters_ = 4 + n_coefficients;
  double now = cost();
  for (int i = 0; i < kSteps; ++i) {
    const Normal normal = sum_up();
    const Eigen::VectorXd step = normal.hessian.ldlt().solve(normal.gradient);
    if (!step.allFinite()) return false;
    const CameraModel camera = camera_;
    const std::vector<BoardPose> poses = poses_;
    double next = now;
    double share = 1.0;
    for (int j = 0; j < kHalvings; ++j, share *= 0.5) {
      move(normal, step, share);
      next = cost();
      if (next < now) break;
      camera_ = camera, poses_ = poses;
    }
    if (!(next < now)) break;
    const bool settled = now - next < kLeastGain * now;
    now = next;
    if (settled) break;
  }
  take_sigma(sum_up());
  return condition_ > 1e-12;
}

void CameraAdjustment::take_sigma(const Normal& normal) {
  const Eigen::VectorXd scale = normal.hessian.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd unit = scale.asDiagonal() * normal.hessian * scale.asDiagonal();
  condition_ = unit.allFinite() ? Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(unit).eigenvalues()(0) : 0.0;
  const Eigen::MatrixXd covariance = normal.hessian.inverse();
  const std::size_t n_coefficients = camera_.lens == LensModel::kEquidistant ? 4 : 5;
  sigma_.assign(4 + n_coefficients, 0.0);
  for (int i = 0; i < n_parameters_; ++i)
    sigma_[static_cast<std::size_t>(i)] = corner_sigma_px() * std::sqrt(covariance(i, i));
}

}  // namespace core
