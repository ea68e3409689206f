#include "core/geometry/gyro_problem.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/gyro_attitude.h"

namespace core {

namespace {

using Eigen::Index;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr int kSettled = 4, kNeighbours = 3;
constexpr double kLeastSigma_px = 0.003, kEnough = 1e-8;
constexpr double kBiasSigma_rad_s = 0.05;  // plausible bias of a MEMS gyro
constexpr std::array<double, kGyroUnknowns> kSteps{1e-5, 1e-5, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4};

// Sum of the outer products of the scores; neighbouring scores with Bartlett weights.
GyroMatrix spread(const std::vector<GyroVector>& scores) {
  GyroMatrix sum = GyroMatrix::Zero();
  for (std::size_t k = 0; k < scores.size(); ++k) {
    sum += scores[k] * scores[k].transpose();
    for (std::size_t lag = 1; lag <= kNeighbours && k + lag < scores.size(); ++lag) {
      const double weight = 1.0 - static_cast<double>(lag) / (kNeighbours + 1);
      sum += weight * (scores[k] * scores[k + lag].transpose() + scores[k + lag] * scores[k].transpose());
    }
  }
  return sum;
}

}  // namespace

struct GyroProblem::Normal {
  GyroMatrix hessian = GyroMatrix::Zero();
  GyroVector gradient = GyroVector::Zero();
  std::vector<GyroVector> scores;        // per fitted pair
  double squares = 0.0, sigma_px = 0.0;  // squares of the points; their sigma, by one step of expectation-maximisation
};

DerotatedFlowModel GyroState::model() const noexcept { return {std::exp(p[kFocal]), sigma_px}; }

DerotatedFlows GyroProblem::flows(const GyroState& state) const {
  const GyroAttitude attitude(gyro_, state.p.segment<3>(kBias));
  DerotatedFlows all(pairs_.size());
  for (std::size_t k = 0; k < pairs_.size(); ++k) rest(state, attitude, pairs_[k], all[k]);
  return all;
}

double GyroProblem::cost(GyroState& state, const DerotatedFlows& flows, bool held_out) const {
  double sum = 0.5 * state.p.segment<3>(kBias).squaredNorm() / (kBiasSigma_rad_s * kBiasSigma_rad_s);
  for (std::size_t k = 0; k < flows.size(); ++k) {
    if (pairs_[k].held_out == held_out) sum += fit_shift(flows[k], state.model(), state.shift_px[k]);
  }
  return sum;
}

void GyroProblem::rest(const GyroState& state, const GyroAttitude& attitude, const FramePair& pair,
                       std::vector<DerotatedFlow>& out) const {
  const double f = std::exp(state.p[kFocal]), readout_s = state.p[kReadout], offset_s = state.p[kOffset];
  const Quaterniond axes = turn(state.p.segment<3>(kAxes)) * state.axes;
  for (const PointPair& point : pair.points) {
    const Vector3d bearing((point.from.u - config_.cx_px) / f, (point.from.v - config_.cy_px) / f, 1.0);
    const Quaterniond first = attitude(pair.from_s + offset_s + readout_s * point.from_fraction);
    const Quaterniond second = attitude(pair.to_s + offset_s + readout_s * point.to_fraction);
    const Vector3d seen = axes * (second.conjugate() * (first * (axes.conjugate() * bearing)));
    const Eigen::Vector2d at = f / seen.z() * seen.head<2>();
    out.push_back({at, Eigen::Vector2d(point.to.u - config_.cx_px, point.to.v - config_.cy_px) - at});
  }
}

// Adds one pair at its fitted translation, where the gradient with respect to the translation is zero.
void GyroProblem::add_pair(const GyroState& state, std::size_t k, const DerotatedFlows& flows,
                           const std::vector<DerotatedFlows>& moved, Normal& normal) const {
  GyroMatrix hessian = GyroMatrix::Zero();
  Eigen::Matrix<double, kGyroUnknowns, 3> mixed = Eigen::Matrix<double, kGyroUnknowns, 3>::Zero();
  Eigen::Matrix3d of_shift = 1e-9 * Eigen::Matrix3d::Identity();
  GyroVector score = GyroVector::Zero();
  const DerotatedFlowModel model = state.model();
  for (std::size_t j = 0; j < flows[k].size(); ++j) {
    const DerotatedFlowTerm term = judge(flows[k][j], state.shift_px[k], model);
    const Eigen::Matrix<double, 2, 3> effect = shift_effect(flows[k][j], model.focal_px);
    Eigen::Matrix<double, 2, kGyroUnknowns> slope;
    for (Index i = 0; i < kGyroUnknowns; ++i) {
      const DerotatedFlow& other = moved[static_cast<std::size_t>(i)][k][j];
      const double step = kSteps[static_cast<std::size_t>(i)];
      slope.col(i) = (other.flow_px - flows[k][j].flow_px) / step;
      score[i] += (judge(other, state.shift_px[k], model).cost - term.cost) / step;
    }
    hessian += slope.transpose() * term.flow_information * slope;
    mixed -= slope.transpose() * term.flow_information * effect;
    of_shift += effect.transpose() * term.information * effect;
    normal.squares += term.weight * term.across_px * term.across_px;
  }
  normal.hessian += hessian - mixed * of_shift.ldlt().solve(mixed.transpose());
  normal.gradient += score;
  normal.scores.push_back(score);
}

GyroProblem::Normal GyroProblem::linearise(const GyroState& state, const DerotatedFlows& flows,
                                           const std::vector<Index>& held) const {
  std::vector<DerotatedFlows> moved;
  for (Index i = 0; i < kGyroUnknowns; ++i) {
    GyroState ahead = state;
    ahead.p[i] += kSteps[static_cast<std::size_t>(i)];
    moved.push_back(this->flows(ahead));
  }
  Normal normal;
  double count = 0.0;
  for (std::size_t k = 0; k < flows.size(); ++k) {
    if (pairs_[k].held_out) continue;
    add_pair(state, k, flows, moved, normal);
    count += static_cast<double>(flows[k].size());
  }
  normal.sigma_px = std::max(kLeastSigma_px, std::sqrt(normal.squares / count));
  for (Index i = kBias; i < kBias + 3; ++i) {
    normal.hessian(i, i) += 1.0 / (kBiasSigma_rad_s * kBiasSigma_rad_s);
    normal.gradient[i] += state.p[i] / (kBiasSigma_rad_s * kBiasSigma_rad_s);
  }
  for (const Index i : held) {
    normal.hessian.row(i).setZero();
    normal.hessian.col(i).setZero();
    normal.hessian(i, i) = 1.0;
    normal.gradient[i] = 0.0;
    for (GyroVector& score : normal.scores) score[i] = 0.0;
  }
  return normal;
}

// Returns true if a step reduced the cost.
bool GyroProblem::step_down(const Normal& normal, Damping& damping, double before, GyroState& state,
                            DerotatedFlows& flows) const {
  double gained = 0.0;
  const bool moved = damped_step(normal.hessian, normal.gradient, damping, [&](const GyroVector& step) {
    GyroState next = state;
    next.p += step;
    next.axes = (turn(next.p.segment<3>(kAxes)) * next.axes).normalized();
    next.p.segment<3>(kAxes).setZero();
    DerotatedFlows after = this->flows(next);
    const double now = cost(next, after);
    if (!(now < before)) return false;
    gained = before - now;
    state = std::move(next);
    flows = std::move(after);
    return true;
  });
  return moved && gained > kEnough * std::abs(before);
}

double GyroProblem::minimise(const std::vector<Index>& held, int most_rounds, GyroState& state) const {
  DerotatedFlows flows = this->flows(state);
  Damping damping;
  int settled = 0;
  for (int round = 0; round < most_rounds && settled < kSettled; ++round) {
    const double before = cost(state, flows);
    const Normal normal = linearise(state, flows, held);
    const bool went = step_down(normal, damping, before, state, flows);
    if (!went) damping = {};
    const bool changed = std::abs(normal.sigma_px - state.sigma_px) > 1e-3 * state.sigma_px;
    state.sigma_px = normal.sigma_px;
    settled = went || changed ? 0 : settled + 1;
  }
  return cost(state, flows);
}

GyroMatrix GyroProblem::covariance(const GyroState& state, const std::vector<Index>& held) const {
  const Normal normal = linearise(state, flows(state), held);
  const GyroMatrix inverse = normal.hessian.ldlt().solve(GyroMatrix::Identity());
  const auto n = static_cast<double>(normal.scores.size());
  return n / std::max(1.0, n - static_cast<double>(kGyroUnknowns)) * inverse * spread(normal.scores) * inverse;
}

}  // namespace core
