#include "core/geometry/motion_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace core {

namespace {

constexpr double kLeastDepth = 0.05;  // relative to the keyframe's; nearer points, or points behind, are not imaged
constexpr double kHuberSigmas = 3.0;
// Lower bound of a point's sigma, set by rounding and optics.
constexpr double kLeastPointSigma_px = 0.003;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& w) noexcept {
  Eigen::Matrix3d m;
  m << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return m;
}

// Rodrigues' formula as a series, exact to 1e-11 at the angles of a camera that still sees the structure.
Eigen::Matrix3d rotation(const Eigen::Vector3d& w) noexcept {
  const double a2 = w.squaredNorm();
  double sine = 1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0 * (1.0 - a2 / 72.0)));
  double versine = 0.5 * (1.0 - a2 / 12.0 * (1.0 - a2 / 30.0 * (1.0 - a2 / 56.0 * (1.0 - a2 / 90.0))));
  if (a2 > 0.25) {
    const double a = std::sqrt(a2);
    sine = std::sin(a) / a;
    versine = (1.0 - std::cos(a)) / a2;
  }
  const Eigen::Matrix3d k = cross_matrix(w);
  return Eigen::Matrix3d::Identity() + sine * k + versine * (k * k);
}

}  // namespace

struct MotionEquations::Row {
  Vector2 px;
  MotionEffect motion;
  Eigen::Matrix<double, 2, kMaxOwn> own;
  Vector2 residual;
};

MotionPose::MotionPose(const MotionVector& motion) noexcept
    : turn(rotation(motion.segment<3>(kPitch))),
      face(rotation({motion(kFaceX), motion(kFaceY), 0.0})),
      shift(motion.segment<3>(kShiftX)) {
  const Eigen::Matrix3d k = cross_matrix(motion.segment<3>(kPitch));
  turn_jacobian = Eigen::Matrix3d::Identity() + 0.5 * k + (k * k) / 6.0;
}

MotionEquations::MotionEquations(double fx, double fy, double readout_s, double reference_share, std::size_t n_regions)
    : fx_(fx), fy_(fy), readout_s_(readout_s), reference_share_(reference_share) {
  cross_.resize(n_regions);
  own_information_.resize(n_regions);
  own_gradient_.resize(n_regions);
}

MotionPose MotionEquations::pose(const MotionStateVector& state, double share) const noexcept {
  return MotionPose(MotionProcess::at(state, readout_s_ * (share - reference_share_)));
}

bool MotionEquations::project(const MotionPoint& point, const MotionRegion& region, double share,
                              const MotionPose& pose, Row& row) const noexcept {
  OwnVector factor = OwnVector::Ones();
  for (std::size_t k = 0; k < kMaxOwn; ++k) {
    if (region.by_row[k]) factor(static_cast<int>(k)) = share - region.share;
  }
  Eigen::Vector3d moved = point.ray - point.middle + point.inverse_depth * pose.shift;
  if (region.n_own > 0) moved += point.own * factor.cwiseProduct(region.value);
  const Eigen::Vector3d faced = pose.face * moved;
  const Eigen::Vector3d y = pose.turn * (point.middle + faced);
  if (!(y.z() > kLeastDepth)) return false;
  const double inverse = 1.0 / y.z();
  row.px = {fx_ * y.x() * inverse, fy_ * y.y() * inverse};
  const Eigen::Vector3d g[2] = {{fx_ * inverse, 0.0, -row.px.u * inverse}, {0.0, fy_ * inverse, -row.px.v * inverse}};
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d inside = pose.turn.transpose() * g[axis];
    row.motion.block<1, 3>(axis, kPitch) = y.cross(g[axis]).transpose() * pose.turn_jacobian;
    const Eigen::Vector3d on_face = pose.face.transpose() * inside;
    row.motion.block<1, 3>(axis, kShiftX) = point.inverse_depth * on_face.transpose();
    row.motion.block<1, 2>(axis, kFaceX) = faced.cross(inside).head<2>().transpose();
    row.own.row(axis) = (point.own.transpose() * on_face).cwiseProduct(factor).transpose();
  }
  return true;
}

void MotionEquations::clear(std::span<MotionRegion> regions) noexcept {
  information_.setZero();
  gradient_.setZero();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    cross_[r].setZero();
    own_gradient_[r].setZero();
    own_information_[r].setIdentity();
    for (int k = 0; k < regions[r].n_own; ++k) {
      const double precision = 1.0 / (regions[r].prior_sd(k) * regions[r].prior_sd(k));
      own_information_[r](k, k) = precision;
      own_gradient_[r](k) = -precision * regions[r].value(k);
    }
    regions[r].n_used = 0;
    regions[r].sum_weight = 0.0;
    regions[r].effect.setZero();
  }
}

void MotionEquations::add(const Row& row, double weight, int n_own, std::size_t region) noexcept {
  const Eigen::Vector2d residual(weight * row.residual.u, weight * row.residual.v);
  information_.noalias() += weight * (row.motion.transpose() * row.motion);
  gradient_.noalias() += row.motion.transpose() * residual;
  if (n_own == 0) return;
  cross_[region].noalias() += weight * (row.motion.transpose() * row.own);
  own_information_[region].noalias() += weight * (row.own.transpose() * row.own);
  own_gradient_[region].noalias() += row.own.transpose() * residual;
}

void MotionEquations::build(const MotionStateVector& state, std::span<const MotionPoint> points,
                            std::span<MotionRegion> regions, const MotionObservation& seen, bool robust) noexcept {
  clear(regions);
  Row row;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (seen.usable[i] == 0) continue;
    MotionRegion& region = regions[points[i].region];
    if (!project(points[i], region, seen.share[i], pose(state, seen.share[i]), row)) continue;
    row.residual = {seen.position[i].u - row.px.u, seen.position[i].v - row.px.v};
    const double sigma_px = std::max(kLeastPointSigma_px, seen.sigma_px[i]);  // a NaN becomes the lower bound
    double weight = 1.0 / (sigma_px * sigma_px);
    const double distance = std::hypot(row.residual.u, row.residual.v);
    if (!std::isfinite(distance)) continue;
    region.effect += weight * row.motion;
    region.sum_weight += weight;
    if (robust && distance > kHuberSigmas * sigma_px) weight *= kHuberSigmas * sigma_px / distance;
    add(row, weight, region.n_own, points[i].region);
    ++region.n_used;
  }
  eliminate(regions);
}

void MotionEquations::eliminate(std::span<MotionRegion> regions) noexcept {
  for (std::size_t r = 0; r < regions.size(); ++r) {
    MotionRegion& region = regions[r];
    if (region.n_used == 0) continue;
    region.effect /= region.sum_weight;
    if (region.n_own == 0) continue;
    const Eigen::LLT<OwnMatrix> solver(own_information_[r]);
    const OwnMatrix inverse = solver.solve(OwnMatrix::Identity());
    const Eigen::Matrix<double, kMotionSize, kMaxOwn> scaled = cross_[r] * inverse;
    information_.noalias() -= scaled * cross_[r].transpose();
    gradient_.noalias() -= scaled * own_gradient_[r];
  }
}

void MotionEquations::update_own(const MotionVector& step, std::span<MotionRegion> regions) noexcept {
  for (std::size_t r = 0; r < regions.size(); ++r) {
    if (regions[r].n_used == 0 || regions[r].n_own == 0) continue;
    const OwnVector rest = own_gradient_[r] - cross_[r].transpose() * step;
    const OwnVector moved = Eigen::LLT<OwnMatrix>(own_information_[r]).solve(rest);
    if (moved.allFinite()) regions[r].value += moved;
  }
}

}  // namespace core
