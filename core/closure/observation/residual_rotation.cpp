#include "core/closure/observation/residual_rotation.h"

#include <Eigen/Cholesky>
#include <utility>

#include "core/linear/damped_least_squares.h"

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Field = Eigen::Matrix<double, 2, 3>;  // px per radian about the camera's axes

constexpr int kRounds = 60;
constexpr double kStep_px = 1e-3, kStill_rad = 1e-7;

Field field_at(const Vector2d& at_px, double f) {
  const double x = at_px.x(), y = at_px.y();
  Field out;
  out << x * y / f, -(f + x * x / f), y, f + y * y / f, -x * y / f, -x;
  return out;
}

struct Normal {
  Matrix3d information = Matrix3d::Zero();  // after elimination of the translation
  Vector3d slope = Vector3d::Zero();        // gradient of the cost with respect to the removed rotation
};

Normal linearise(const std::vector<DerotatedFlow>& flows, const DerotatedFlowModel& model, const Vector3d& shift_px) {
  Normal out;
  Matrix3d rotations = Matrix3d::Zero(), mixed = Matrix3d::Zero(), shifts = 1e-9 * Matrix3d::Identity();
  for (const DerotatedFlow& flow : flows) {
    const Field field = field_at(flow.at_px, model.focal_px);
    const Field effect = shift_effect(flow, model.focal_px);
    const DerotatedFlowTerm term = judge(flow, shift_px, model);
    for (Index axis = 0; axis < 2; ++axis) {
      DerotatedFlow less = flow;
      less.flow_px[axis] -= kStep_px;
      out.slope += field.row(axis).transpose() * (judge(less, shift_px, model).cost - term.cost) / kStep_px;
    }
    rotations += field.transpose() * term.flow_information * field;
    const Field by_shift = depth_lever(flow, effect * shift_px) * effect;
    const Matrix2d& of_flow = term.flow_information;
    mixed += field.transpose() * of_flow * by_shift;
    shifts += by_shift.transpose() * of_flow * by_shift + effect.transpose() * (term.information - of_flow) * effect;
  }
  out.information = rotations - mixed * shifts.ldlt().solve(mixed.transpose());
  return out;
}

std::vector<DerotatedFlow> without(std::vector<DerotatedFlow> flows, const Vector3d& rotation, double f) {
  for (DerotatedFlow& flow : flows) flow.flow_px -= field_at(flow.at_px, f) * rotation;
  return flows;
}

}  // namespace

ResidualRotation residual_rotation(std::vector<DerotatedFlow> flows, const DerotatedFlowModel& model,
                                   Vector3d shift_px) {
  ResidualRotation out;
  double best = fit_shift(flows, model, shift_px), stepped_rad = 0.0;
  Damping damping{.least = 1e-3};
  const auto lowers = [&](const Vector3d& step) {
    std::vector<DerotatedFlow> next = without(flows, step, model.focal_px);
    Vector3d shift = shift_px;
    const double now = fit_shift(next, model, shift);
    if (!(now < best)) return false;
    best = now, shift_px = shift, flows = std::move(next);
    out.rotation += step;
    stepped_rad = step.norm();
    return true;
  };
  for (int round = 0; round < kRounds; ++round) {
    const Normal normal = linearise(flows, model, shift_px);
    out.information = normal.information;
    if (!damped_step(normal.information, normal.slope, damping, lowers) || stepped_rad < kStill_rad) break;
  }
  return out;
}

}  // namespace core::closure
