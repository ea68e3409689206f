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
// A shift along the axes of all regions is told from a turn by little but perspective, unless something rests in the
// structure's plane: .3 px in each frame, fifty times the noise of a channel. Where a frame tells a shift so poorly,
// what is taken away is the turn alone that the resting points then show, which leaves some of a shift in all channels
// alike (half of it, for a background twice as far) rather than such noise. open() names it.
//
// How large w and t are (one number each) is learned from the record: the prior's variance follows what the data moved
// the state by against what they should [empirical Bayes; Mehra 1970], so that what is at rest is held at rest, and
// what two components share (the yaw and the sideways shift of a background) goes where their like (pitch, roll;
// height, distance) move more.
//
// Roll comes from what rests: a bending cantilever's sections tilt, which looks the same, so regions may tilt freely.
//
// One thread; nothing allocates after construction; the same bits in every run. Never NaN: frames whose solution is not
// finite are counted and left at the prediction.
class CameraMotion {
 public:
  // t_keyframe_s: when row 0 of the keyframe was read, any origin. At least one region rests, or turns are measured.
  CameraMotion(const CameraMotionConfig& config, const std::vector<KeyframePoint>& points,
               const std::vector<KeyframeRegion>& regions, double t_keyframe_s);

  // To the frame whose row 0 is read at t_s. Time that runs back counts as standing still.
  void predict(double t_s) noexcept;
  // What correct() takes for the camera's turn beside the points; empty (as at first): nothing.
  void measure_turn(const std::optional<TurnMeasurement>& turn) noexcept { turn_ = turn; }
  [[nodiscard]] bool sees_turns() const noexcept { return rests_; }  // something rests
  // Works from the last prediction; may be called again with another choice of points.
  void correct(const MotionObservation& seen) noexcept;
  // The frame is done: learn from it, and leave out what it tells too poorly. True: state() is no longer the estimate.
  bool settle() noexcept;

  // Motion of a point in its plane with the camera's motion taken away, px of the keyframe. Before settle() with all
  // components, after it without those that are open.
  [[nodiscard]] Vector2 stabilised(std::size_t i, const Vector2& position, double share) const noexcept;

  [[nodiscard]] const MotionStateVector& state() const noexcept { return taken_; }
  // The same with what is open.
  [[nodiscard]] const MotionStateVector& estimate() const noexcept { return process_.mean(); }
  [[nodiscard]] const MotionStateMatrix& covariance() const noexcept { return process_.covariance(); }
  [[nodiscard]] const MotionVector& prior_sd() const noexcept { return sd_; }
  // Magnification against the keyframe at the structure's middle: < 1 farther away.
  [[nodiscard]] double magnification() const noexcept;
  // Weighted mean over the region's points in use of d(px) / d(component), rows u and v.
  [[nodiscard]] const MotionEffect& region_effect(std::size_t region) const noexcept { return regions_[region].effect; }
  // Components that these data leave open: too poorly told in a frame, or unknown by more than what matters.
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
  std::array<double, 2> log_variance_{};  // of turns and of shifts, in units of base_
  bool raised_ = false, rests_ = false;
  MotionStateVector taken_ = MotionStateVector::Zero();  // what is taken from the points
  double t_s_, dt_s_ = 0.0;
  Eigen::Vector3d middle_ = Eigen::Vector3d::UnitZ();  // of the structure: ray
  MotionMatrix position_covariance_ = MotionMatrix::Zero();
  MotionMatrix information_ = MotionMatrix::Zero();  // of this frame, any measured turn included
  std::array<bool, kMotionSize> open_{};
  std::uint64_t n_failed_ = 0;
  MotionEquations equations_;
  std::optional<TurnMeasurement> turn_;
};

}  // namespace core
