#pragma once

#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/rolling_shutter.h"
#include "core/geometry/scale_factor.h"
#include "core/types/displacement.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace core {

struct ChannelDisplacementConfig {
  std::vector<Region> regions;
  CameraModel camera;
  ReadoutModel readout;
  double rate_hz = 0.0;
  double scale_mm_per_px = 1.0;  // S_0, of the keyframe
  // Per region, where an oblique plane or a length of its own gives it another scale than S_0; empty = S_0 for all.
  std::vector<double> region_scale_mm_per_px = {};
  bool adaptive_scale = true;  // per-frame scale (paper Eq. 6)
  bool paper_method = false;   // two-point scale; rolling shutter by Eqs. 7-8 on the samples, with rho = 1
  double inlier_sigma_px = 0.3;
  int min_points = 3;  // fewer inliers: the channel has no sample in this frame
};

// From the points of one frame to the displacement of every channel relative to the keyframe (paper Eq. 4):
//   d = S_i (p_i - c) - S_0 (p_0 - c), weighted mean of the region's inliers, along the region's axis; c = principal
//   point.
// Points are undistorted, per-frame scale is estimated from them, outliers are rejected per region by MLESAC.
// `hovermodal` leaves the samples at the instants at which rows were read and states the delay of each channel
// (ARCHITECTURE.md); `paper` moves them to row 0 with Eqs. 7-8. Background regions make no channel.
// One thread; nothing allocates after construction.
class ChannelDisplacement {
 public:
  // keyframe: the first frame's tracks; every point that will come, seen.
  ChannelDisplacement(ChannelDisplacementConfig config, const TrackFrame& keyframe);

  [[nodiscard]] const std::vector<ChannelInfo>& channels() const noexcept { return channels_; }

  // Sets `inlier` of the points and fills `out` (sized by sample_prototype()).
  void update(TrackFrame& tracks, DisplacementSample& out) noexcept;
  [[nodiscard]] DisplacementSample sample_prototype() const;

 private:
  struct RegionRange {
    std::size_t begin = 0, end = 0;  // of the points
  };

  void make_channels();
  void place_points(const TrackFrame& tracks) noexcept;
  [[nodiscard]] double estimate_scale() noexcept;
  void reject_outliers(double magnification) noexcept;
  void compensate_rolling_shutter() noexcept;
  [[nodiscard]] double scale_of(std::uint16_t region) const noexcept;
  [[nodiscard]] Vector2 scaled_motion(std::size_t point, double magnification) const noexcept;
  void average_channel(std::size_t channel, double magnification, const TrackFrame& tracks,
                       DisplacementSample& out) const noexcept;

  ChannelDisplacementConfig config_;
  std::vector<ChannelInfo> channels_;
  std::vector<RegionRange> ranges_;    // per region
  std::vector<Vector2> keyframe_;      // undistorted px
  std::vector<double> weight_;         // of a point in its channel: inverse variance by its texture, constant
  std::vector<double> readout_share_;  // along the readout, of the raw row: rows are read as they lie on the sensor
  ScaleFactor scale_;
  std::vector<Vector2> position_, motion_;  // undistorted px; scale-corrected step since the keyframe, keyframe px
  std::vector<std::uint8_t> seen_, inlier_;
  std::vector<Vector2> last_region_motion_;  // paper mode: for V_rel
  std::vector<std::uint8_t> has_last_;
};

}  // namespace core
