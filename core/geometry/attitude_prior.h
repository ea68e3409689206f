#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/camera_motion.h"
#include "core/types/attitude.h"

namespace core {

struct AttitudeConfig {
  double sigma_rad = 1e-3;                  // white noise of a sample, per axis
  std::array<double, 3> mount_rpy_rad{};    // of the camera relative to the body: 0 = looks forward, top up
  double delay_s = 0.0;                     // from the start of row 0 to the instant of the estimated motion
  double most_gap_s = 0.25;                 // longest gap that is interpolated, and oldest sample that is used
  std::size_t n_kept = 4096;                // received samples that are kept; a record is kept whole
  std::vector<AttitudeSample> record = {};  // samples known in advance
};

// Attitude as a measurement of the camera's rotation. With C(t) = A(t) M^T, A the attitude, M from body to camera axes,
// the camera's rotation relative to the keyframe is
//     R(w(t)) = C(t)^T C_ref,      C_ref = C(t_1) R(w(t_1)) at the first frame t_1 with an attitude
// A is interpolated between the samples around the frame's instant (slerp); a frame newer than all samples uses the
// newest, with its variance raised by the rate of rotation. The reference's error (the noise of that first attitude, a
// drifting compass) is common to neighbouring frames: a bias per axis, modelled as a random walk, is estimated. If the
// image contradicts the attitude by more than six standard deviations in most frames (wrong mounting, different clocks,
// or a stated noise that is too small), it is dropped and this is reported. One thread; does not allocate after
// construction. Invalid samples (NaN, zero, time that does not increase) are counted and ignored.
class AttitudePrior {
 public:
  explicit AttitudePrior(AttitudeConfig config);

  void take(const AttitudeSample& sample) noexcept;
  // Call between predict() and correct() of the frame at t_s; after() follows settle().
  void before(CameraMotionEstimator& motion, double t_s) noexcept;
  void after(const CameraMotionEstimator& motion) noexcept;

  // Rotation of the camera relative to the first attitude requested, and its standard deviation (rad, per axis).
  struct Turn {
    Eigen::Quaterniond camera;  // C(t)
    double sigma_rad = 0.0;
  };
  [[nodiscard]] std::optional<Turn> at(double t_s) const noexcept;

  [[nodiscard]] bool given_up() const noexcept { return given_up_; }
  [[nodiscard]] std::uint64_t n_used() const noexcept { return n_used_; }        // frames
  [[nodiscard]] std::uint64_t n_without() const noexcept { return n_without_; }  // frames without a sample nearby
  [[nodiscard]] std::uint64_t n_refused() const noexcept { return n_refused_; }  // samples
  [[nodiscard]] const Eigen::Vector3d& bias_rad() const noexcept { return bias_rad_; }

 private:
  struct Kept {
    double t_s = 0.0;
    Eigen::Quaterniond camera = Eigen::Quaterniond::Identity();
  };
  [[nodiscard]] const Kept& kept(std::size_t i) const noexcept { return ring_[(first_ + i) % ring_.size()]; }

  AttitudeConfig config_;
  Eigen::Quaterniond to_body_;  // M^T
  std::vector<Kept> ring_;
  std::size_t first_ = 0, n_ = 0;
  std::optional<Eigen::Quaterniond> reference_;  // C_ref
  std::optional<Eigen::Vector3d> measured_;      // of this frame, bias subtracted
  double sigma_rad_ = 0.0, last_s_ = 0.0;
  Eigen::Vector3d bias_rad_ = Eigen::Vector3d::Zero(), bias_variance_;
  double contradicted_ = 0.0;  // share of recent frames
  bool given_up_ = false;
  std::uint64_t n_used_ = 0, n_without_ = 0, n_refused_ = 0;
};

}  // namespace core
