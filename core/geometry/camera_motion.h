#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/motion_equations.h"
#include "core/geometry/motion_process.h"
#include "core/types/vector2.h"

namespace core {

// One point of the keyframe. (x, y, 1) = its ray, undistorted; q = 1 / depth, 0 for far away.
struct KeyframePoint {
  double x = 0.0, y = 0.0;
  double inverse_depth = 0.0;  // 1/mm
  double readout_share = 0.0;  // along the readout, of the raw row
  double sigma_px = 0.03;
  std::uint16_t region = 0;
};

struct CameraMotionConfig {
  double fx = 0.0, fy = 0.0;    // px
  double distance_mm = 1000.0;  // to the structure: size of what a translation may be
  double readout_s = 0.0;       // signed
  bool perspective = true;      // false: focal length unknown: roll, zoom and common shift only
  bool turns_measured = false;  // measure_turn() tells turns where nothing rests
};

// The turn w against the keyframe from elsewhere (attitude_prior.h); the same standard deviation about each axis.
struct TurnMeasurement {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  double sigma_rad = 1.0;
};

// Motion of the camera against the keyframe on the full projection. For a point with ray r and inverse depth q:
//   y = R(w) [c + R(f) (r - c + sum_k nu_k col_k + q t)]        seen at (fx y_x / y_z, fy y_y / y_z)
// w, t, f are smooth in time (MotionProcess) and taken at the instant at which the point's row is read; t counts in the
// keyframe's axes, so that a shift of the camera and a slide of all regions are one and the same column. nu are free in
// every frame, per region, with next to no prior: sliding along the region's axes (col = q axis), that slide's change
// over the rows, turning in its plane, and for far points zoom. So nothing that the structure does along its axes can
// pass for camera motion, whatever its readout.
//
// f turns the view about the middle c of the structure (of each other region: its own middle) and has next to no prior.
// The perspective pattern (x^2, xy, y^2) tells yaw and pitch by it, but so faintly (0.5 px of the whole image in each
// frame) that it must not move the channels: f takes it up, and leaves w and t to what shifts.
//
// Where no region rests, yaw and pitch stay zero and f and t are all there is: what is common to all channels along
// their axes is left in them, rather than filled with the noise of perspective.
//
// How large w and t are (one number each) is learned from the record: the prior's variance follows what the data moved
// the state by against what they should [empirical Bayes; Mehra 1970], so that what is at rest is held at rest, and
// what two components share (the yaw and the sideways shift of a background) goes where their like (pitch, roll;
// height, distance) move more.
//
// Roll comes from a region's own turning and from what regions do across their axes. A bending cantilever's sections
// tilt, which looks the same: where a region rests, tilt is free and the resting points alone tell roll; where none
// does, tilt has a variance that is learned, and bending passes for roll.
//
// One thread; nothing allocates after construction; the same bits in every run. Never NaN: frames whose solution is not
// finite are counted and left at the prediction.
class CameraMotion {
 public:
  // t_keyframe_s: when row 0 of the keyframe was read, any origin.
  CameraMotion(const CameraMotionConfig& config, const std::vector<KeyframePoint>& points,
               const std::vector<KeyframeRegion>& regions, double t_keyframe_s);

  // To the frame whose row 0 is read at t_s. Time that runs back counts as standing still.
  void predict(double t_s) noexcept;
  // What correct() takes for the camera's turn beside the points; empty (as at first): nothing.
  void measure_turn(const std::optional<TurnMeasurement>& turn) noexcept { turn_ = turn; }
  [[nodiscard]] bool sees_turns() const noexcept { return !learns_tilt_; }  // something rests
  // Works from the last prediction; may be called again with another choice of points.
  void correct(const MotionObservation& seen) noexcept;
  // The frame is done: learn from it.
  void settle() noexcept;

  // Motion of a point in its plane with the camera's motion taken away, px of the keyframe.
  [[nodiscard]] Vector2 stabilised(std::size_t i, const Vector2& position, double share) const noexcept;

  [[nodiscard]] const MotionStateVector& state() const noexcept { return process_.mean(); }
  [[nodiscard]] const MotionStateMatrix& covariance() const noexcept { return process_.covariance(); }
  [[nodiscard]] const MotionVector& prior_sd() const noexcept { return sd_; }
  // Magnification against the keyframe at the structure's middle: < 1 farther away.
  [[nodiscard]] double magnification() const noexcept;
  // Weighted mean over the region's points in use of d(px) / d(component), rows u and v.
  [[nodiscard]] const MotionEffect& region_effect(std::size_t region) const noexcept { return regions_[region].effect; }
  // Components that these data leave open by more than what matters (kOpenPx in the channels).
  [[nodiscard]] std::array<bool, kMotionSize> open() const noexcept { return open_; }
  // Standard deviation in px, along (e_u, e_v), of the camera's motion that was taken from a region, for what is not
  // open: what is open stays in the channels as it is.
  [[nodiscard]] double sigma_px(std::size_t region, double e_u, double e_v) const noexcept;
  [[nodiscard]] std::uint64_t n_failed() const noexcept { return n_failed_; }

 private:
  // The state's instant is that of this row.
  [[nodiscard]] static double mean_share(const std::vector<KeyframePoint>& points) noexcept;
  [[nodiscard]] bool in_plane(const MotionPoint& point) const noexcept;
  void place_middles(const std::vector<KeyframePoint>& points);
  void add_own_columns(const std::vector<KeyframePoint>& points);
  void set_sd() noexcept;
  void learn() noexcept;
  void iterate(const MotionObservation& seen) noexcept;
  void add_turn(const MotionStateVector& linear, MotionMatrix& information, MotionVector& gradient) const noexcept;
  [[nodiscard]] bool surprised() noexcept;
  void find_open() noexcept;

  CameraMotionConfig config_;
  std::vector<MotionPoint> points_;
  std::vector<MotionRegion> regions_;
  MotionProcess process_, before_, settled_;
  MotionVector base_, sd_;
  std::array<double, 2> log_variance_{};  // of turns and of shifts, in units of base_
  double tilt_variance_ = 1e-6;           // rad^2
  bool raised_ = false, learns_tilt_ = true;
  double t_s_, dt_s_ = 0.0;
  Eigen::Vector3d middle_ = Eigen::Vector3d::UnitZ();  // of the structure: ray
  Eigen::Matrix<double, kMotionSize, kMotionSize> position_covariance_;
  std::array<bool, kMotionSize> open_{};
  std::uint64_t n_failed_ = 0;
  MotionEquations equations_;
  std::optional<TurnMeasurement> turn_;
};

}  // namespace core
