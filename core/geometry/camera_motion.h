#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/motion_equations.h"
#include "core/geometry/motion_keyframe.h"
#include "core/geometry/motion_process.h"
#include "core/types/vector2.h"

namespace core {

struct CameraMotionConfig {
  double fx = 0.0, fy = 0.0;    // px
  double distance_mm = 1000.0;  // to the structure: scale of plausible translations
  double readout_s = 0.0;       // signed
};

// Rotation w relative to the keyframe from another sensor (attitude_prior.h); the same standard deviation for all axes.
struct TurnMeasurement {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  double sigma_rad = 1.0;
};

// Ego-motion: camera relative to the keyframe, on the full projection. For a point with ray r and inverse depth q:
//   y = R(w) [c + R(f) (r - c + sum_k nu_k col_k + q t)]        seen at (fx y_x / y_z, fy y_y / y_z)
// w, t, f are smooth in time (MotionProcess) and evaluated at the instant at which the point's row is read; t is in the
// keyframe's axes, so a translation of the camera and a common slide of all regions share one column. nu are free in
// every frame, per region, with an almost flat prior: translation along the region's axes (col = q axis), the change of
// this translation over the rows, rotation in its plane, and zoom of far points. Structural motion along these axes can
// therefore not be mistaken for camera motion, whatever the readout.
//
// f rotates the view about the centre c of the structure (of each other region: its own centre) and has an almost flat
// prior. The perspective pattern (x^2, xy, y^2) is evidence of yaw and pitch, but so weak (0.5 px of the whole image
// per frame) that it must not move the channels: f absorbs it, and w and t follow the displacements.
//
// Translation along the regions' axes can be distinguished from rotation only by perspective, unless a static region
// lies in the structure's plane: 0.3 px per frame, fifty times the noise of a channel. Where translation is so weakly
// observable, only the rotation shown by the static points is removed. Instead of that noise, part of the translation
// remains in all channels alike (half of it, if the background is twice as far away). open() reports it.
//
// The magnitudes of w and t (one number each) are estimated from the record: the prior's variance follows the ratio of
// actual to expected updates [empirical Bayes; Mehra 1970]. A static camera is thus estimated as static, and motion
// shared by two components (yaw and sideways translation of a background) is attributed to the one whose counterparts
// (pitch, roll; height, distance) move more.
//
// Roll is estimated from static regions only: the tilt of a bending cantilever looks the same, so regions tilt freely.
//
// One thread; does not allocate after construction; bit-identical in every run. Never NaN: frames whose solution is not
// finite are counted and keep the prediction.
class CameraMotionEstimator {
 public:
  // t_keyframe_s: time at which row 0 of the keyframe was read, any origin. Needs a static region or measured
  // rotations.
  CameraMotionEstimator(const CameraMotionConfig& config, const std::vector<KeyframePoint>& points,
                        const std::vector<KeyframeRegion>& regions, double t_keyframe_s);

  // Predicts the frame whose row 0 is read at t_s. A time before the last one counts as the same time.
  void predict(double t_s) noexcept;
  // Rotation that correct() uses in addition to the points; empty (initially): none.
  void measure_turn(const std::optional<TurnMeasurement>& turn) noexcept { turn_ = turn; }
  [[nodiscard]] bool sees_turns() const noexcept { return rests_; }  // a static region exists
  // Starts from the last prediction; may be called again with another selection of points.
  void correct(const MotionObservation& seen) noexcept;
  // Ends the frame: updates the prior's variances, drops weakly observable components. True: state() != estimate().
  bool settle() noexcept;

  // Motion of a point in its plane after removal of the camera's motion, px of the keyframe. Before settle() with all
  // components, after it without unobservable ones.
  [[nodiscard]] Vector2 stabilised(std::size_t i, const Vector2& position, double share) const noexcept;

  [[nodiscard]] const MotionStateVector& state() const noexcept { return taken_; }
  // The same state including unobservable components.
  [[nodiscard]] const MotionStateVector& estimate() const noexcept { return process_.mean(); }
  [[nodiscard]] const MotionStateMatrix& covariance() const noexcept { return process_.covariance(); }
  [[nodiscard]] const MotionVector& prior_sd() const noexcept { return sd_; }
  // Magnification relative to the keyframe at the structure's centre: < 1 farther away.
  [[nodiscard]] double magnification() const noexcept;
  // Weighted mean over the region's points in use of d(px) / d(component), rows u and v.
  [[nodiscard]] const MotionEffect& region_effect(std::size_t region) const noexcept { return regions_[region].effect; }
  // Unobservable components: too weakly observed in this frame, or with too large an uncertainty.
  [[nodiscard]] std::array<bool, kMotionSize> open() const noexcept { return open_; }
  // Standard deviation in px, along (e_u, e_v), of the camera motion removed from a region. Observable components only:
  // the others are not removed.
  [[nodiscard]] double sigma_px(std::size_t region, double e_u, double e_v) const noexcept;
  [[nodiscard]] std::uint64_t n_failed() const noexcept { return n_failed_; }

 private:
  // Readout fraction of the row to whose instant the state refers.
  [[nodiscard]] static double mean_share(const std::vector<KeyframePoint>& points) noexcept;
  void set_sd() noexcept;
  void learn() noexcept;
  void iterate(const MotionObservation& seen) noexcept;
  void add_turn(const MotionStateVector& linear, MotionVector& gradient) noexcept;
  [[nodiscard]] bool surprised() noexcept;
  [[nodiscard]] bool leave_out_poorly_told() noexcept;
  void find_open() noexcept;
  [[nodiscard]] double effect_px(const MotionVector& motion, std::size_t region) const noexcept;
  void give_up(int component) noexcept;

  CameraMotionConfig config_;
  std::vector<MotionPoint> points_;
  std::vector<MotionRegion> regions_;
  MotionProcess process_, before_, settled_;
  MotionVector base_, sd_;
  std::array<double, 2> log_variance_{};  // of rotation and translation, in units of base_
  bool raised_ = false, rests_ = false;
  MotionStateVector taken_ = MotionStateVector::Zero();  // motion that is removed from the points
  double t_s_, dt_s_ = 0.0;
  Eigen::Vector3d middle_ = Eigen::Vector3d::UnitZ();  // ray to the centre of the structure
  MotionMatrix position_covariance_ = MotionMatrix::Zero();
  MotionMatrix information_ = MotionMatrix::Zero();  // of this frame, including a measured rotation
  std::array<bool, kMotionSize> open_{};
  std::uint64_t n_failed_ = 0;
  MotionEquations equations_;
  std::optional<TurnMeasurement> turn_;
};

}  // namespace core
