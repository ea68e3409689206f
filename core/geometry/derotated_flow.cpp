#include "core/geometry/derotated_flow.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/linear/damped_least_squares.h"

namespace core {

namespace {

constexpr double kDegrees = 3.0;  // of Student's t
constexpr double kLeastShift_px = 1e-6;
constexpr int kFlowRounds = 40;
constexpr double kSettledShare = 1e-7;  // of the cost

}  // namespace

Eigen::Matrix<double, 2, 3> shift_effect(const DerotatedFlow& point, double focal_px) noexcept {
  Eigen::Matrix<double, 2, 3> effect;
  effect << 1.0, 0.0, -point.at_px.x() / focal_px, 0.0, 1.0, -point.at_px.y() / focal_px;
  return effect;
}

Eigen::Matrix2d depth_lever(const DerotatedFlow& point, const Eigen::Vector2d& d_px) noexcept {
  const double size = d_px.norm();
  if (size < kLeastShift_px) return Eigen::Matrix2d::Identity();
  const Eigen::Vector2d e = d_px / size;
  return e * e.transpose() + point.flow_px.dot(e) / size * (Eigen::Matrix2d::Identity() - e * e.transpose());
}

DerotatedFlowTerm judge(const DerotatedFlow& point, const Eigen::Vector3d& shift_px,
                        const DerotatedFlowModel& model) noexcept {
  const Eigen::Vector2d d = shift_effect(point, model.focal_px) * shift_px;
  const double size = d.norm(), s2 = model.sigma_px * model.sigma_px, along2 = s2 + size * size;
  const Eigen::Vector2d e =
      size > kLeastShift_px ? Eigen::Vector2d(d / size) : Eigen::Vector2d(Eigen::Vector2d::UnitX());
  const Eigen::Vector2d h(-e.y(), e.x());
  const double there = point.flow_px.dot(e), along = there - size;
  DerotatedFlowTerm term;
  term.across_px = point.flow_px.dot(h);
  const double distance2 = along * along / along2 + term.across_px * term.across_px / s2;
  term.weight = (kDegrees + 2.0) / (kDegrees + distance2);
  term.cost = 0.5 * (kDegrees + 2.0) * std::log1p(distance2 / kDegrees) + 0.5 * std::log(along2 * s2);
  // Along e the length of d changes, and with it the variance; along h the direction of d.
  const double growth = size / along2;
  const double by_length = -2.0 * along / along2 - 2.0 * along * along * growth / along2;
  const double by_turn = size > kLeastShift_px ? 2.0 * term.across_px * (along / along2 - there / s2) / size : 0.0;
  term.slope = (0.5 * term.weight * by_length + growth) * e + 0.5 * term.weight * by_turn * h;
  const double share = std::min(1.0, term.weight);
  const Eigen::Matrix2d ee = e * e.transpose(), hh = h * h.transpose();
  term.flow_information = share * (ee / along2 + hh / s2);
  term.information = term.flow_information + growth * growth * ee;
  return term;
}

double cost(std::span<const DerotatedFlow> points, const Eigen::Vector3d& shift_px,
            const DerotatedFlowModel& model) noexcept {
  double sum = 0.0;
  for (const DerotatedFlow& point : points) sum += judge(point, shift_px, model).cost;
  return sum;
}

double fit_shift(std::span<const DerotatedFlow> points, const DerotatedFlowModel& model,
                 Eigen::Vector3d& shift_px) noexcept {
  double now = cost(points, shift_px, model);
  Damping damping;
  for (int round = 0; round < kFlowRounds; ++round) {
    Eigen::Matrix3d information = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();
    for (const DerotatedFlow& point : points) {
      const DerotatedFlowTerm term = judge(point, shift_px, model);
      const Eigen::Matrix<double, 2, 3> effect = shift_effect(point, model.focal_px);
      // Without the lever, steps from a |d| far below the flow are too long across it, and most of them are refused.
      const Eigen::Matrix2d lever = depth_lever(point, effect * shift_px);
      const Eigen::Matrix2d of_length = term.information - term.flow_information;
      information += effect.transpose() * (lever * term.flow_information * lever + of_length) * effect;
      slope += effect.transpose() * term.slope;
    }
    double gained = 0.0;
    const bool moved = damped_step(information, slope, damping, [&](const Eigen::Vector3d& step) {
      const double then = cost(points, shift_px + step, model);
      if (!(then < now)) return false;
      gained = now - then;
      shift_px += step;
      now = then;
      return true;
    });
    if (!moved || gained <= kSettledShare * std::abs(now)) break;
  }
  return now;
}

}  // namespace core
