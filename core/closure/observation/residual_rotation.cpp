#include "core/closure/observation/residual_rotation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace core::closure {
namespace {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Field = Eigen::Matrix<double, 2, 3>;  // px per radian about the camera's axes

constexpr int kRounds = 60;
constexpr double kStep_px = 1e-3, kStill_rad = 1e-7, kLeastShift_px = 1e-6;
constexpr double kLeastDamping = 1e-3, kMostDamping = 1e6;

Field field_at(const Vector2d& at_px, double f) {
  const double x = at_px.x(), y = at_px.y();
  Field out;
  out << x * y / f, -(f + x * x / f), y, f + y * y / f, -x * y / f, -x;
  return out;
}

// Change of a static point's expected flow with d, the flow of a point of mean depth: unchanged along the epipolar
// line; across it, the rotation of the line times the point's own flow along it. The difference in depth that this flow
// shows distinguishes rotation from translation.
Matrix2d lever(const DerotatedFlow& flow, const Vector2d& d) {
  const double size = d.norm();
  if (size < kLeastShift_px) return Matrix2d::Identity();
  const Vector2d e = d / size;
  return e * e.transpose() + flow.flow_px.dot(e) / size * (Matrix2d::Identity() - e * e.transpose());
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
    const Field by_shift = lever(flow, effect * shift_px) * effect;
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
  double before = fit_shift(flows, model, shift_px), damping = kLeastDamping;
  for (int round = 0; round < kRounds; ++round) {
    const Normal normal = linearise(flows, model, shift_px);
    out.information = normal.information;
    bool went = false;
    Vector3d change = Vector3d::Zero();
    for (; damping < kMostDamping && !went; damping *= 10.0) {
      Matrix3d raised = normal.information;
      raised.diagonal() *= 1.0 + damping;
      change = -raised.ldlt().solve(normal.slope);
      if (!change.allFinite()) return out;
      std::vector<DerotatedFlow> next = without(flows, change, model.focal_px);
      Vector3d shift = shift_px;
      const double now = fit_shift(next, model, shift);
      if (!(now < before)) continue;
      went = true;
      before = now, shift_px = shift, flows = std::move(next);
      out.rotation += change;
      damping = std::max(kLeastDamping, 0.01 * damping);  // one tenth, together with the factor in the loop
    }
    if (!went || change.norm() < kStill_rad) break;
  }
  return out;
}

}  // namespace core::closure
