#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/closure/noise_stream.h"
#include "core/closure/observation/observation_record.h"
#include "core/types/track.h"

namespace test_support {

inline constexpr double kPi = 3.14159265358979;

// Three floors and a base, eight points each, that sway and hover; noise of 0.03 px.
struct Hidden {
  double roll_rms_rad = 0.0, k1 = 0.0, locking_px = 0.0, readout_frames = 0.0;
};
inline core::closure::ObservationRecord swaying_record(Eigen::Index n_frames, const Hidden& hidden) {
  core::closure::ObservationRecord r;
  r.rate_hz = 25.0, r.alpha_px = 2000.0, r.cx_px = 960.0, r.cy_px = 540.0, r.width_px = 1920, r.height_px = 1080;
  const std::size_t n = 32;
  r.u_px.resize(n_frames, static_cast<Eigen::Index>(n));
  r.v_px = r.u_px;
  core::closure::NoiseStream noise(7);
  for (int floor = 0; floor < 4; ++floor) {
    core::Region region;
    region.name = "floor" + std::to_string(floor);
    region.role = floor == 0 ? core::RegionRole::kBase : core::RegionRole::kStructure;
    r.regions.push_back(region);
  }
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t floor = j / 8, i = j % 8;
    r.region_of_point.push_back(floor);
    r.sigma_px.push_back(0.03);
    const double x = -150.0 + 43.3 * static_cast<double>(i);  // positions spread over all sub-pixel fractions
    const double y = 400.0 - 260.0 * static_cast<double>(floor) + 17.4 * static_cast<double>((i * 3) % 8) - 60.0;
    for (Eigen::Index k = 0; k < n_frames; ++k) {
      const double t = (static_cast<double>(k) + hidden.readout_frames * (r.cy_px + y) / r.height_px) / r.rate_hz;
      const double sway = 2.0 * static_cast<double>(floor) * std::sin(2.0 * kPi * 1.7 * t);
      const double roll = hidden.roll_rms_rad * std::sqrt(2.0) * std::sin(2.0 * kPi * 0.23 * t + 1.0);
      const double du = x + sway + 8.0 * std::sin(0.9 * t) + roll * y, dv = y + 5.0 * std::cos(0.7 * t) - roll * x;
      const double bent = 1.0 + hidden.k1 * (du * du + dv * dv) / (r.alpha_px * r.alpha_px);
      const double u = r.cx_px + bent * du, v = r.cy_px + bent * dv;
      const auto j_point = static_cast<Eigen::Index>(j);
      r.u_px(k, j_point) = u + hidden.locking_px * std::sin(2.0 * kPi * u) + 0.03 * noise.gaussian();
      r.v_px(k, j_point) = v + hidden.locking_px * std::sin(2.0 * kPi * v) + 0.03 * noise.gaussian();
    }
  }
  return r;
}

// One frame of it, in the form of the tracker.
inline core::TrackFrame track_frame(const core::closure::ObservationRecord& record, Eigen::Index k) {
  core::TrackFrame frame;
  frame.sequence = static_cast<std::uint64_t>(k);
  frame.t_start_ns = std::llround(1e9 * static_cast<double>(k) / record.rate_hz);
  for (Eigen::Index j = 0; j < record.n_points(); ++j) {
    core::TrackPoint point;
    point.u_px = record.u_px(k, j);
    point.v_px = record.v_px(k, j);
    const auto i = static_cast<std::size_t>(j);
    point.sigma_px = record.sigma_px[i];
    point.id = static_cast<std::uint32_t>(i);
    point.region = static_cast<std::uint16_t>(record.region_of_point[i]);
    point.seen = point.inlier = std::isfinite(point.u_px) && std::isfinite(point.v_px);
    frame.points.push_back(point);
  }
  return frame;
}

}  // namespace test_support
