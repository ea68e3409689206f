#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "core/geometry/channel_displacement.h"

namespace test_support {

// A front view of plates that slide along u, seen by a camera that drifts: exact projections, implemented here
// independently of core/geometry.
struct PlateView {
  static constexpr double kAlpha = 1000.0;  // px
  static constexpr double kDepth = 2000.0;  // mm: 2 mm/px in the keyframe
  static constexpr int kWidth = 640, kHeight = 480;

  core::CameraModel camera{kAlpha, kAlpha, 322.0, 236.0, {}};
  double readout_s = 0.0;
  double rate_hz = 25.0;
  int points_per_plate = 16;
  // Plate centres along v, mm from the optical axis.
  std::vector<double> plate_y_mm{-300.0, 0.0, 300.0};

  [[nodiscard]] core::ChannelDisplacementConfig config() const {
    core::ChannelDisplacementConfig c;
    for (std::size_t r = 0; r < plate_y_mm.size(); ++r) {
      c.regions.push_back({"floor" + std::to_string(r + 1), 0, 0, 1, 1, core::RegionRole::kStructure, 0.0, false});
    }
    c.camera = camera;
    c.readout = {readout_s, core::ReadoutDirection::kDown, kWidth, kHeight};
    c.rate_hz = rate_hz;
    c.scale_mm_per_px = kDepth / kAlpha;
    return c;
  }

  // Frame that starts at t_s. plate(r, t): slide along u, mm; zoom(t): stand-off divided by kDepth.
  template <class Plate, class Zoom>
  [[nodiscard]] core::TrackFrame frame(double t_s, Plate plate, Zoom zoom) const {
    core::TrackFrame tracks;
    tracks.sequence = static_cast<std::uint64_t>(std::llround(t_s * rate_hz));
    tracks.t_start_ns = std::llround(t_s * 1e9);
    for (std::size_t r = 0; r < plate_y_mm.size(); ++r) {
      for (int i = 0; i < points_per_plate; ++i) {
        const double x_mm = -350.0 + 700.0 * std::fmod(0.618034 * i, 1.0);
        const double y_mm = plate_y_mm[r] - 40.0 + 80.0 * i / points_per_plate;
        core::TrackPoint point;
        double v = camera.cy;
        for (int pass = 0; pass < 6; ++pass) {  // iterates, because the row determines the time, and the time the row
          const double t = t_s + readout_s * v / kHeight;
          const double z_mm = kDepth * zoom(t);
          const core::Vector2 raw =
              camera.distort({camera.cx + kAlpha * (x_mm + plate(r, t)) / z_mm, camera.cy + kAlpha * y_mm / z_mm});
          point.u_px = raw.u;
          point.v_px = v = raw.v;
        }
        point.sigma_px = 0.04;
        point.id = static_cast<std::uint32_t>(tracks.points.size());
        point.region = static_cast<std::uint16_t>(r);
        point.seen = true;
        tracks.points.push_back(point);
      }
    }
    return tracks;
  }
};

// The channels of a run, frame by frame.
struct Measured {
  core::ChannelDisplacement channels;
  core::DisplacementSample sample;

  Measured(const core::ChannelDisplacementConfig& config, const core::TrackFrame& keyframe)
      : channels(config, keyframe), sample(channels.sample_prototype()) {}
  const core::DisplacementSample& operator()(core::TrackFrame& tracks) {
    channels.update(tracks, sample);
    return sample;
  }
};

}  // namespace test_support
