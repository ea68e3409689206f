#pragma once

#include <Eigen/Core>
#include <array>

namespace core {

// Estimated camera motion relative to the keyframe: rotation vector w (rad) and translation t (mm) that map keyframe
// camera coordinates to present ones, and two rotations about the centre of the view (rad, about x and y).
inline constexpr int kMotionSize = 8;
enum MotionIndex : int {
  kPitch = 0,   // w about x
  kYaw = 1,     // w about y
  kRoll = 2,    // w about the optical axis
  kShiftX = 3,  // t
  kShiftY = 4,
  kShiftZ = 5,
  kFaceX = 6,  // perspective rotation about x through the centre: see camera_motion.h
  kFaceY = 7
};
// Each component with its first and second time derivative: entry d * kMotionSize + i is derivative d of component i.
inline constexpr int kMotionState = 3 * kMotionSize;

using MotionVector = Eigen::Matrix<double, kMotionSize, 1>;
using MotionStateVector = Eigen::Matrix<double, kMotionState, 1>;
using MotionStateMatrix = Eigen::Matrix<double, kMotionState, kMotionState>;
using MotionMatrix = Eigen::Matrix<double, kMotionSize, kMotionSize>;

// Independent stationary Gaussian processes with Matern covariance, nu = 5/2 (power density ~ (1 + (f/fc)^2)^-3, as of
// an aircraft in position hold), in state-space form [Hartikainen & Sarkka 2010]: exact for any time step. Unobserved
// components keep the prior's variance. One thread; does not allocate.
class MotionProcess {
 public:
  explicit MotionProcess(double corner_hz);

  // Starts at the keyframe: position zero and known; derivatives with the prior's variance. sd: of each component.
  void start(const MotionVector& sd) noexcept;
  // A negative dt_s counts as 0.
  void predict(double dt_s, const MotionVector& sd) noexcept;
  // Data on the components themselves, with information matrix `information` and gradient `rhs` about the predicted
  // mean: the most likely state is the predicted one + step. May be called again with other data; no information matrix
  // is inverted. false: not finite.
  [[nodiscard]] bool step(const MotionMatrix& information, const MotionVector& rhs, MotionStateVector& step) noexcept;
  // Applies the last step; the covariance is positive semidefinite by construction.
  void accept(const MotionStateVector& step) noexcept;

  [[nodiscard]] const MotionStateVector& mean() const noexcept { return mean_; }
  [[nodiscard]] const MotionStateMatrix& covariance() const noexcept { return covariance_; }
  // Components at `tau_s` after the state's instant.
  [[nodiscard]] static MotionVector at(const MotionStateVector& state, double tau_s) noexcept;

 private:
  using Matrix3 = Eigen::Matrix3d;

  [[nodiscard]] Matrix3 transition(double dt_s) const noexcept;
  [[nodiscard]] Matrix3 process_noise(double dt_s, const Matrix3& transition) const noexcept;
  void factor() noexcept;

  double lambda_;       // rad/s
  Matrix3 stationary_;  // of unit variance
  MotionStateVector mean_ = MotionStateVector::Zero();
  MotionStateMatrix covariance_ = MotionStateMatrix::Zero();
  MotionStateMatrix root_ = MotionStateMatrix::Zero();  // lower-triangular root of the predicted covariance
  MotionMatrix inner_ = MotionMatrix::Identity();       // Cholesky factor of I + L^T information L
  MotionStateMatrix work_ = MotionStateMatrix::Zero(), half_ = MotionStateMatrix::Zero();
};

}  // namespace core
