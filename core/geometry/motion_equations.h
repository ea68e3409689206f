#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/motion_process.h"
#include "core/types/vector2.h"

namespace core {

// Kind of motion that a region's points may have relative to the keyframe.
struct KeyframeRegion {
  enum class Kind : std::uint8_t {
    kMoving,  // translates along its axes, may rotate in its plane: structure, base
    kStatic,  // static, at known depths
    kFar,     // static, far away (depths unknown)
  };
  Kind kind = Kind::kMoving;
  std::array<Eigen::Vector3d, 2> axis{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};  // unit, in the keyframe
  int n_axes = 1;
  bool background = false;                            // not in the structure's plane
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // normal of its plane
};

// Largest number of a region's own motions.
inline constexpr int kMaxOwn = 5;
using OwnVector = Eigen::Matrix<double, kMaxOwn, 1>;
using OwnMatrix = Eigen::Matrix<double, kMaxOwn, kMaxOwn>;
using MotionEffect = Eigen::Matrix<double, 2, kMotionSize>;  // d(u, v px) / d(component)

// A point of the keyframe in y = R(w) [c + R(f) (r - c + sum_k nu_k col_k + q t)] (camera_motion.h).
struct MotionPoint {
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ(), middle = ray;   // r, c
  Eigen::Matrix<double, 3, kMaxOwn> own = decltype(own)::Zero();  // col_k
  double inverse_depth = 0.0;                                     // q, 1/mm
  std::uint16_t region = 0;
};

struct MotionRegion {
  KeyframeRegion about;
  int n_own = 0;
  std::array<bool, kMaxOwn> by_row{};  // true: the column of nu_k is multiplied by (share - this share)
  double share = 0.0;
  OwnVector value = OwnVector::Zero(), prior_sd = OwnVector::Ones();  // nu
  std::uint32_t n_used = 0;
  double sum_weight = 0.0;                     // of the points in use, 1/px^2
  MotionEffect effect = MotionEffect::Zero();  // weighted mean over the points in use
};

// Undistorted px from the principal point; readout fraction of the raw row of the point's present position.
struct MotionObservation {
  std::span<const Vector2> position;
  std::span<const double> share;
  std::span<const double> sigma_px;
  std::span<const std::uint8_t> usable;
};

// Camera pose at one row.
struct MotionPose {
  Eigen::Matrix3d turn, face, turn_jacobian;  // R(w), R(f), left Jacobian of w
  Eigen::Vector3d shift;

  explicit MotionPose(const MotionVector& motion) noexcept;
};

// Normal equations of one frame, with every region's own motions eliminated (Schur complement). One thread; does not
// allocate after construction.
class MotionEquations {
 public:
  MotionEquations(double fx, double fy, double readout_s, double reference_share, std::size_t n_regions);

  // Linearises about `state` and the regions' values. robust: Huber weights. Sets n_used and effect of the regions.
  void build(const MotionStateVector& state, std::span<const MotionPoint> points, std::span<MotionRegion> regions,
             const MotionObservation& seen, bool robust) noexcept;
  // Updates the regions' values after a step of the camera parameters.
  void update_own(const MotionVector& step, std::span<MotionRegion> regions) noexcept;

  [[nodiscard]] const MotionMatrix& information() const noexcept { return information_; }
  [[nodiscard]] const MotionVector& gradient() const noexcept { return gradient_; }
  [[nodiscard]] MotionPose pose(const MotionStateVector& state, double share) const noexcept;

 private:
  struct Row;

  [[nodiscard]] bool project(const MotionPoint& point, const MotionRegion& region, double share, const MotionPose& pose,
                             Row& row) const noexcept;
  void add(const Row& row, double weight, int n_own, std::size_t region) noexcept;
  void clear(std::span<MotionRegion> regions) noexcept;
  void eliminate(std::span<MotionRegion> regions) noexcept;

  double fx_, fy_, readout_s_, reference_share_;
  MotionMatrix information_;
  MotionVector gradient_;
  std::vector<Eigen::Matrix<double, kMotionSize, kMaxOwn>> cross_;
  std::vector<OwnMatrix> own_information_;
  std::vector<OwnVector> own_gradient_;
};

}  // namespace core
