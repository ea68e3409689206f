#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/geometry/derotated_flow.h"
#include "core/geometry/gyro_readout.h"
#include "core/linear/damped_least_squares.h"

namespace core {

// Likelihood of the model in gyro_readout.h, and its maximisation.

enum GyroUnknown : Eigen::Index { kReadout, kOffset, kFocal, kBias, kAxes = kBias + 3, kGyroUnknowns = kAxes + 3 };
using GyroVector = Eigen::Matrix<double, kGyroUnknowns, 1>;
using GyroMatrix = Eigen::Matrix<double, kGyroUnknowns, kGyroUnknowns>;
using DerotatedFlows = std::vector<std::vector<DerotatedFlow>>;  // per pair

struct GyroState {
  GyroVector p = GyroVector::Zero();  // focal length as logarithm; axes as a small rotation after `axes`
  Eigen::Quaterniond axes = Eigen::Quaterniond::Identity();
  double sigma_px = 1.0;
  std::vector<Eigen::Vector3d> shift_px;  // per pair

  [[nodiscard]] DerotatedFlowModel model() const noexcept;
};

// Keeps references to its constructor's arguments.
class GyroProblem {
 public:
  GyroProblem(const std::vector<FramePair>& pairs, const std::vector<GyroSample>& gyro, const GyroReadoutConfig& config)
      : pairs_(pairs), gyro_(gyro), config_(config) {}

  [[nodiscard]] DerotatedFlows flows(const GyroState& state) const;
  // Minus log likelihood of the pairs that are (not) held out; fits their translations.
  double cost(GyroState& state, const DerotatedFlows& flows, bool held_out = false) const;
  // Levenberg-Marquardt over all parameters except `held`; returns the cost.
  double minimise(const std::vector<Eigen::Index>& held, int most_rounds, GyroState& state) const;
  [[nodiscard]] GyroMatrix covariance(const GyroState& state, const std::vector<Eigen::Index>& held) const;
  [[nodiscard]] const std::vector<FramePair>& pairs() const noexcept { return pairs_; }

 private:
  struct Normal;

  void rest(const GyroState& state, const class GyroAttitude& attitude, const FramePair& pair,
            std::vector<DerotatedFlow>& out) const;
  void add_pair(const GyroState& state, std::size_t k, const DerotatedFlows& flows,
                const std::vector<DerotatedFlows>& moved, Normal& normal) const;
  [[nodiscard]] Normal linearise(const GyroState& state, const DerotatedFlows& flows,
                                 const std::vector<Eigen::Index>& held) const;
  [[nodiscard]] bool step_down(const Normal& normal, Damping& damping, double before, GyroState& state,
                               DerotatedFlows& flows) const;

  const std::vector<FramePair>& pairs_;
  const std::vector<GyroSample>& gyro_;
  const GyroReadoutConfig& config_;
};

}  // namespace core
