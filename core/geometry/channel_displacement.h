#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/geometry/attitude_prior.h"
#include "core/geometry/camera_following.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/camera_motion.h"
#include "core/geometry/channel_layout.h"
#include "core/geometry/motion_contradiction.h"
#include "core/geometry/plane_pose.h"
#include "core/geometry/point_correction.h"
#include "core/geometry/published_shutter.h"
#include "core/geometry/rolling_shutter.h"
#include "core/geometry/scale_factor.h"
#include "core/geometry/slow_rotation.h"
#include "core/types/displacement.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace core {

struct ChannelDisplacementConfig {
  std::vector<Region> regions;
  CameraModel camera;
  PointCorrection places = {};  // corrections beyond the declared camera
  ReadoutModel readout;
  double rate_hz = 0.0;
  double scale_mm_per_px = 1.0;  // S_0, of the keyframe
  // Scale per region, if an oblique plane or a length of its own gives it another scale than S_0; empty = S_0 for all.
  std::vector<double> region_scale_mm_per_px = {};
  std::optional<PlanePose> plane = {};                  // of the structure; empty: frontal view
  bool adaptive_scale = true;                           // true: camera motion is removed; false: the camera is static
  CameraFollowing following = CameraFollowing::kWhole;  // kDistance where the camera's motion cannot be measured
  bool witness = true;                                  // static regions are measured as witnesses, unless kWhole
  bool paper_method = false;  // two-point scale; rolling shutter by Eqs. 7-8 on the samples, with rho = 1
  ShutterVelocity shutter_velocity = ShutterVelocity::kCamera;  // choice of V_rel in paper_method
  std::optional<AttitudeConfig> attitude = {};  // measured attitude, if any; delay_s contains half the exposure
  double inlier_sigma_px = 0.3;
  int min_points = 3;  // with fewer inliers the channel has no sample in this frame
};

// Converts the points of one frame to the displacement of every channel relative to the keyframe: each point's motion
// in the structure's plane without the camera's motion (CameraMotionEstimator), weighted mean over the region's
// inliers, along the region's axis. Scale only, and `paper` (Eq. 4): d = S_i (p_i - c) - S_0 (p_0 - c), c = principal
// point. Points are undistorted; outliers are rejected per region by MLESAC about the predicted, then the estimated
// motion. `hovermodal` leaves the samples at the instants at which rows were read and states the delay of each channel
// (METHOD.md); `paper` moves them to row 0 with Eqs. 7-8. Static regions (background, ground) are not channels. Unless
// the whole motion of the camera is followed, the static region with the most points, without its own zoom, is a
// witness of what stays of the camera's translation along each direction of the channels and, if its points spread far
// enough, of its rotation about the optical axis; the slow part of its rotation is removed first, if `following` says
// so. Unobservable camera motion (sideways translation if only the
// structure is seen) remains in all channels alike; sigma_mm does not contain it. One thread; does not allocate after
// construction.
class ChannelDisplacement {
 public:
  // raw_keyframe: tracks of the first frame; it must contain every later point, seen.
  ChannelDisplacement(ChannelDisplacementConfig config, const TrackFrame& raw_keyframe);

  [[nodiscard]] const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }
  // The channels, followed by the witnesses.
  [[nodiscard]] const std::vector<ChannelInfo>& spectra() const noexcept { return spectra_; }

  [[nodiscard]] const std::vector<Region>& regions() const noexcept { return config_.regions; }
  [[nodiscard]] std::size_t n_points() const noexcept { return keyframe_.size(); }
  [[nodiscard]] std::size_t n_witnesses() const noexcept { return spectra_.size() - channels_.size(); }

  // Sets `inlier` of the points and fills `out` (sized by sample_prototype()).
  void update(TrackFrame& tracks, DisplacementSample& out) noexcept;
  [[nodiscard]] DisplacementSample sample_prototype() const;

  // True after the points contradicted the camera motion for long (motion_contradiction.h): since then only the scale
  // has been estimated.
  [[nodiscard]] bool camera_given_up() const noexcept { return contradiction_.lasts(); }
  // Adds a new attitude sample, before the frames at its time; ignored without config.attitude.
  void take(const AttitudeSample& sample) noexcept {
    if (attitude_) attitude_->take(sample);
  }
  // null: no attitude is declared, or no camera motion is estimated.
  [[nodiscard]] const AttitudePrior* attitude() const noexcept { return attitude_ ? &*attitude_ : nullptr; }
  // null: camera motion is not estimated.
  [[nodiscard]] const CameraMotionEstimator* camera_motion() const noexcept {
    return camera_motion_ ? &*camera_motion_ : nullptr;
  }

 private:
  [[nodiscard]] bool follows_camera() const noexcept { return camera_motion_ && !camera_given_up(); }
  struct RegionRange {
    std::size_t begin = 0, end = 0;  // range of its points
    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
  };

  [[nodiscard]] std::vector<RegionPoints> region_points() const;
  void make_channels();
  void follow_what_rests(DisplacementSample& out) noexcept;
  void place_points(const TrackFrame& tracks) noexcept;
  // From the instant of the static region to that of the point's row, s.
  [[nodiscard]] double after_resting_s(std::size_t point) const noexcept {
    return config_.readout.readout_s * share_now_[point] - spectra_.back().row_delay_s;
  }
  [[nodiscard]] double follow_camera(std::int64_t t_start_ns) noexcept;
  // Largest mean motion of a static region, after removal of the camera's.
  [[nodiscard]] double largest_resting_px() const noexcept;
  [[nodiscard]] double estimate_scale() noexcept;
  void stabilise() noexcept;
  void reject_outliers() noexcept;
  [[nodiscard]] PublishedShutter make_published_shutter() const;
  [[nodiscard]] double scale_of(std::uint16_t region) const noexcept;
  void remove_scale(double magnification) noexcept;
  // Weighted mean of a region's inliers; the same sigma along every axis.
  struct Average {
    Vector2 mean_px;
    double sigma_px = 0.0;
    std::uint16_t n_points = 0;
    bool enough = false;
    [[nodiscard]] double along(const ChannelInfo& channel) const noexcept {
      return mean_px.u * channel.direction_u + mean_px.v * channel.direction_v;
    }
  };
  [[nodiscard]] Average average(std::uint16_t region) const noexcept;
  // Part of a list of points that belongs to the region of the witnesses.
  template <class T>
  [[nodiscard]] std::span<T> resting(std::vector<T>& of_points) const noexcept {
    const RegionRange& range = ranges_[spectra_.back().region];
    return {of_points.data() + range.begin, range.size()};
  }
  void average_channel(std::size_t channel, double magnification, DisplacementSample& out) const noexcept;

  ChannelDisplacementConfig config_;
  bool corrects_places_;
  std::vector<ChannelInfo> channels_, spectra_;
  std::vector<RegionRange> ranges_;    // per region
  std::vector<Vector2> keyframe_;      // undistorted px
  std::vector<double> weight_;         // weight of a point in its channel: inverse variance from its texture, constant
  std::vector<double> readout_share_;  // readout fraction of the raw row: rows are read in the order of the sensor
  ScaleFactor scale_;
  MotionContradiction contradiction_;
  std::optional<CameraMotionEstimator> camera_motion_;  // empty: scale only, paper, or a static camera
  std::optional<AttitudePrior> attitude_;
  std::optional<SlowRotation> slow_rotation_;  // removed from position_
  std::vector<Vector2> turned_;                // what it makes of keyframe_
  std::int64_t t_turned_ns_ = 0;               // frame of its last update
  std::vector<Vector2> position_, motion_;     // undistorted px from the principal point; motion since the keyframe
                                               // without the camera's motion, keyframe px
  std::vector<double> share_now_, sigma_px_;   // readout fraction of the point's present row; sigma in this frame
  std::vector<std::uint8_t> seen_, inlier_, inlier_before_;
  PublishedShutter shutter_;  // paper mode
};

}  // namespace core
