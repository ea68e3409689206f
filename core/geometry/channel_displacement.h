#pragma once

#include <optional>
#include <vector>

#include "core/geometry/attitude_prior.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/camera_motion.h"
#include "core/geometry/channel_layout.h"
#include "core/geometry/plane_pose.h"
#include "core/geometry/point_correction.h"
#include "core/geometry/published_shutter.h"
#include "core/geometry/rolling_shutter.h"
#include "core/geometry/scale_factor.h"
#include "core/types/displacement.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace core {

struct ChannelDisplacementConfig {
  std::vector<Region> regions;
  CameraModel camera;
  PointCorrection places = {};  // beyond the declared camera
  ReadoutModel readout;
  double rate_hz = 0.0;
  double scale_mm_per_px = 1.0;  // S_0, of the keyframe
  // Per region, where an oblique plane or a length of its own gives it another scale than S_0; empty = S_0 for all.
  std::vector<double> region_scale_mm_per_px = {};
  std::optional<PlanePose> plane = {};  // of the structure; empty: it faces the camera
  bool adaptive_scale = true;           // follow the camera; false: it stands still
  bool scale_only = false;              // of its motion only the distance (paper Eq. 6), from all points
  bool witness = true;                  // where only the scale is followed: what rests is followed beside
  bool paper_method = false;            // two-point scale; rolling shutter by Eqs. 7-8 on the samples, with rho = 1
  ShutterVelocity shutter_velocity = ShutterVelocity::kCamera;  // V_rel there
  std::optional<AttitudeConfig> attitude = {};  // an attitude is measured beside; delay_s counts for half the exposure
  double inlier_sigma_px = 0.3;
  int min_points = 3;  // fewer inliers: the channel has no sample in this frame
};

// From the points of one frame to the displacement of every channel relative to the keyframe: each point's motion in
// the structure's plane with the camera's motion taken away (CameraMotionEstimator), weighted mean of the region's
// inliers, along the region's axis. Scale only, and `paper` (Eq. 4): d = S_i (p_i - c) - S_0 (p_0 - c), c = principal
// point. Points are undistorted; outliers are rejected per region by MLESAC about the predicted, then the estimated
// motion. `hovermodal` leaves the samples at the instants at which rows were read and states the delay of each channel
// (METHOD.md); `paper` moves them to row 0 with Eqs. 7-8. What rests (background, ground) makes no channel, but
// where only the scale is followed a witness of the camera's shift along each direction of the channels: the resting
// region with the most points, its own zoom taken away.
// What no data tell of the camera's motion (its sideways shift, where nothing but the structure is seen) stays in all
// channels alike; sigma_mm is without it.
// One thread; nothing allocates after construction.
class ChannelDisplacement {
 public:
  // raw_keyframe: the first frame's tracks; every point that will come, seen.
  ChannelDisplacement(ChannelDisplacementConfig config, const TrackFrame& raw_keyframe);

  [[nodiscard]] const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }
  // The channels, then the witnesses.
  [[nodiscard]] const std::vector<ChannelInfo>& spectra() const noexcept { return spectra_; }

  [[nodiscard]] const std::vector<Region>& regions() const noexcept { return config_.regions; }
  [[nodiscard]] std::size_t n_points() const noexcept { return keyframe_.size(); }
  [[nodiscard]] std::size_t n_witnesses() const noexcept { return spectra_.size() - channels_.size(); }

  // Sets `inlier` of the points and fills `out` (sized by sample_prototype()).
  void update(TrackFrame& tracks, DisplacementSample& out) noexcept;
  [[nodiscard]] DisplacementSample sample_prototype() const;

  // Most points contradicted it for two seconds and more (something was declared to rest that does not): only the scale
  // has been followed since.
  [[nodiscard]] bool camera_given_up() const noexcept { return camera_given_up_; }
  // An attitude sample that came since, before the frames it tells of; ignored without config.attitude.
  void take(const AttitudeSample& sample) noexcept {
    if (attitude_) attitude_->take(sample);
  }
  // null: none was announced, or no camera motion is estimated.
  [[nodiscard]] const AttitudePrior* attitude() const noexcept { return attitude_ ? &*attitude_ : nullptr; }
  // null: not estimated.
  [[nodiscard]] const CameraMotionEstimator* camera_motion() const noexcept {
    return camera_motion_ ? &*camera_motion_ : nullptr;
  }

 private:
  [[nodiscard]] bool follows_camera() const noexcept { return camera_motion_ && !camera_given_up_; }
  struct RegionRange {
    std::size_t begin = 0, end = 0;  // of the points
    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
  };

  [[nodiscard]] std::vector<RegionPoints> region_points() const;
  void make_channels();
  void follow_what_rests() noexcept;
  void place_points(const TrackFrame& tracks) noexcept;
  [[nodiscard]] double follow_camera(std::int64_t t_start_ns) noexcept;
  [[nodiscard]] double estimate_scale() noexcept;
  void stabilise() noexcept;
  void reject_outliers() noexcept;
  [[nodiscard]] PublishedShutter make_published_shutter() const;
  [[nodiscard]] double scale_of(std::uint16_t region) const noexcept;
  void remove_scale(double magnification) noexcept;
  // Weighted mean of a region's inliers along an axis.
  struct Average {
    double mean_px = 0.0, sigma_px = 0.0;
    std::uint16_t n_points = 0;
    bool enough = false;
  };
  [[nodiscard]] Average average(const ChannelInfo& info) const noexcept;
  void average_channel(std::size_t channel, double magnification, DisplacementSample& out) const noexcept;

  ChannelDisplacementConfig config_;
  bool corrects_places_;
  std::vector<ChannelInfo> channels_, spectra_;
  std::vector<RegionRange> ranges_;    // per region
  std::vector<Vector2> keyframe_;      // undistorted px
  std::vector<double> weight_;         // of a point in its channel: inverse variance by its texture, constant
  std::vector<double> readout_share_;  // along the readout, of the raw row: rows are read as they lie on the sensor
  ScaleFactor scale_;
  int n_contradicted_ = 0;
  bool camera_given_up_ = false;
  std::optional<CameraMotionEstimator> camera_motion_;  // none: scale only, paper, or a camera that stands still
  std::optional<AttitudePrior> attitude_;
  std::vector<Vector2> position_, motion_;    // undistorted px from the principal point; step since the keyframe with
                                              // the camera's motion taken away, keyframe px
  std::vector<double> share_now_, sigma_px_;  // of the row where the point is now; of this frame
  std::vector<std::uint8_t> seen_, inlier_, inlier_before_;
  PublishedShutter shutter_;  // paper mode
};

}  // namespace core
