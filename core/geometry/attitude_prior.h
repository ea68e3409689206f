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
  std::array<double, 3> mount_rpy_rad{};    // of the camera against the body: 0 = looks ahead, its top up
  double delay_s = 0.0;                     // from the start of row 0 to the instant that the motion counts for
  double most_gap_s = 0.25;                 // samples farther apart, or older, tell nothing in between
  std::size_t n_kept = 4096;                // of samples that arrive; a whole record is kept whole
  std::vector<AttitudeSample> record = {};  // known beforehand
};

// Attitude as a measurement of the camera's turns. With C(t) = A(t) M^T, A the attitude, M from body to camera axes, a
// camera turns against the keyframe by
//     R(w(t)) = C(t)^T C_ref,      C_ref = C(t_1) R(w(t_1)) at the first frame t_1 with an attitude
// A is interpolated between the samples around the frame's instant (slerp); a frame that is newer than all of them
// takes the newest, its variance raised by how fast it turned. The datum's error (the noise of that first attitude, a
// compass that drifts) is the same for all frames around: a bias per axis, a random walk, is learned beside. Given up,
// and told so, when the picture contradicts it by more than six standard deviations in most frames: a wrong mounting,
// clocks that differ, or a noise stated too small. One thread; nothing allocates after construction. What is no
// attitude (NaN, zero, time that stands or runs back) is counted and left out.
class AttitudePrior {
 public:
  explicit AttitudePrior(AttitudeConfig config);

  void take(const AttitudeSample& sample) noexcept;
  // Between predict() and correct() of the frame at t_s; after settle().
  void before(CameraMotion& motion, double t_s) noexcept;
  void after(const CameraMotion& motion) noexcept;

  // The camera's turn against the first attitude asked for, and its standard deviation (rad, per axis).
  struct Turn {
    Eigen::Quaterniond camera;  // C(t)
    double sigma_rad = 0.0;
  };
  [[nodiscard]] std::optional<Turn> at(double t_s) const noexcept;

  [[nodiscard]] bool given_up() const noexcept { return given_up_; }
  [[nodiscard]] std::uint64_t n_used() const noexcept { return n_used_; }        // frames
  [[nodiscard]] std::uint64_t n_without() const noexcept { return n_without_; }  // frames that no sample lies near
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
  std::optional<Eigen::Vector3d> measured_;      // of this frame, less the bias
  double sigma_rad_ = 0.0, last_s_ = 0.0;
  Eigen::Vector3d bias_rad_ = Eigen::Vector3d::Zero(), bias_variance_;
  double contradicted_ = 0.0;  // share of the frames lately
  bool given_up_ = false;
  std::uint64_t n_used_ = 0, n_without_ = 0, n_refused_ = 0;
};

}  // namespace core
