#include "core/geometry/gyro_start.h"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/geometry/gyro_attitude.h"

namespace core {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastStartTurn_rad = 5e-4;  // rms per frame: a smaller rotation is below the tracks' noise
constexpr double kOffsetStep_s = 2e-3;
constexpr double kHandicap = 1.5;  // penalty of arbitrary axes: camera translations bias them

// Camera rotation between two frames to first order, by least squares over the points.
Vector3d image_rotation(const FramePair& pair, const GyroReadoutConfig& config, double focal_px) {
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const PointPair& point : pair.points) {
    const double x = (point.from.u - config.cx_px) / focal_px, y = (point.from.v - config.cy_px) / focal_px;
    const Vector3d u(x * y, -(1.0 + x * x), y), v(1.0 + y * y, -x * y, -x);
    normal += u * u.transpose() + v * v.transpose();
    right += u * (point.to.u - point.from.u) / focal_px + v * (point.to.v - point.from.v) / focal_px;
  }
  return normal.ldlt().solve(right);
}

// Subtracts the mean and returns the rms of the remainder.
double take_mean(std::vector<Vector3d>& turns) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& turn : turns) mean += turn / static_cast<double>(turns.size());
  double squares = 0.0;
  for (Vector3d& turn : turns) turn -= mean, squares += turn.squaredNorm();
  return std::sqrt(squares / static_cast<double>(turns.size()));
}

Matrix3d nearest_rotation(const Matrix3d& m) {
  const Eigen::JacobiSVD<Matrix3d> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0);
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

// The 24 rotations that map coordinate axes to coordinate axes.
std::vector<Matrix3d> aligned_axes() {
  std::vector<Matrix3d> all;
  for (int first = 0; first < 6; ++first) {
    for (int second = 0; second < 6; ++second) {
      if (first / 2 == second / 2) continue;
      Matrix3d axes = Matrix3d::Zero();
      axes(first / 2, 0) = first % 2 == 0 ? 1.0 : -1.0;
      axes(second / 2, 1) = second % 2 == 0 ? 1.0 : -1.0;
      axes.col(2) = axes.col(0).cross(axes.col(1));
      all.push_back(axes);
    }
  }
  return all;
}

double misfit(const std::vector<Vector3d>& seen, const Matrix3d& axes, const std::vector<Vector3d>& felt) {
  double sum = 0.0;
  for (std::size_t k = 0; k < seen.size(); ++k) sum += (seen[k] - axes * felt[k]).norm();
  return sum;
}

}  // namespace

GyroStart start_from_turns(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro,
                           const GyroReadoutConfig& config, double focal_px) {
  std::vector<Vector3d> seen, felt(pairs.size());
  for (const FramePair& pair : pairs) seen.push_back(image_rotation(pair, config, focal_px));
  if (!(take_mean(seen) > kLeastStartTurn_rad))
    throw std::invalid_argument("gyro readout: the camera hardly rotates: rotate it faster, about all three axes");
  const GyroAttitude attitude(gyro, Vector3d::Zero());
  const std::vector<Matrix3d> chips = aligned_axes();
  GyroStart best;
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Matrix3d& axes, double offset_s, double handicap) {
    const double sum = handicap * misfit(seen, axes, felt);
    if (sum >= least) return;
    least = sum;
    best = {Eigen::Quaterniond(axes), offset_s};
  };
  for (double offset_s = -config.most_offset_s; offset_s <= config.most_offset_s; offset_s += kOffsetStep_s) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Eigen::AngleAxisd step(attitude(pairs[k].from_s + offset_s).conjugate() *
                                   attitude(pairs[k].to_s + offset_s));
      felt[k] = step.angle() * step.axis();
    }
    (void)take_mean(felt);
    Matrix3d correlation = Matrix3d::Zero();
    for (std::size_t k = 0; k < seen.size(); ++k) correlation += seen[k] * felt[k].transpose();
    consider(nearest_rotation(correlation), offset_s, kHandicap);
    for (const Matrix3d& axes : chips) consider(axes, offset_s, 1.0);
  }
  return best;
}

}  // namespace core
