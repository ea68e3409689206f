#include "core/geometry/keyframe_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace core {

namespace {

// Without a calibration: image widths to the picture; perspective is then a thousandth of what a lens shows.
constexpr double kNarrowView = 50.0;

KeyframeRegion keyframe_region(const Region& region, bool calibrated) {
  KeyframeRegion out;
  out.background = region.role == RegionRole::kBackground;
  if (!makes_channel(region.role)) {
    // Without a focal length the distances are made up: a depth in metres says nothing.
    const bool far = out.background && (!calibrated || !(region.depth_m > 0.0));
    out.kind = far ? KeyframeRegion::Kind::kFar : KeyframeRegion::Kind::kStatic;
    return out;
  }
  const double angle = region.axis_deg * std::numbers::pi / 180.0;
  out.n_axes = region.both_axes ? 2 : 1;
  if (!region.both_axes) out.axis[0] = {std::cos(angle), std::sin(angle), 0.0};
  return out;
}

// Axes that are meant to be one, but for how they were drawn or for perspective, become one: where each had its own
// direction, the differences would seem to tell the shift along them.
void share_axis(std::vector<KeyframeRegion>& regions) {
  constexpr double kAlike = 0.996;  // cosine of 5 degrees
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto single = [](const KeyframeRegion& r) { return r.kind == KeyframeRegion::Kind::kMoving && r.n_axes == 1; };
  for (const KeyframeRegion& region : regions) {
    if (single(region)) sum += sum.dot(region.axis[0]) < 0.0 ? Eigen::Vector3d(-region.axis[0]) : region.axis[0];
  }
  if (!(sum.norm() > 0.0)) return;
  sum.normalize();
  for (KeyframeRegion& region : regions) {
    if (single(region) && std::abs(sum.dot(region.axis[0])) > kAlike) region.axis[0] = sum;
  }
}

}  // namespace

CameraMotion make_camera_motion(const std::vector<Region>& regions, const CameraModel& camera,
                                const ReadoutModel& readout, double scale_mm_per_px, const TrackFrame& keyframe) {
  CameraMotionConfig config;
  config.perspective = camera.calibrated();
  const double narrow_px = kNarrowView * std::max(readout.width_px, readout.height_px);
  config.fx = config.perspective ? camera.fx : narrow_px;
  config.fy = config.perspective ? camera.fy : narrow_px;
  config.readout_s = readout.readout_s;
  const double scale = std::isfinite(scale_mm_per_px) && scale_mm_per_px > 0.0 ? scale_mm_per_px : 1.0;
  config.distance_mm = 0.5 * (config.fx + config.fy) * scale;

  std::vector<KeyframeRegion> about;
  for (const Region& region : regions) about.push_back(keyframe_region(region, config.perspective));
  share_axis(about);
  std::vector<KeyframePoint> points;
  for (const TrackPoint& p : keyframe.points) {
    const Vector2 ideal = camera.undistort({p.u_px, p.v_px});
    KeyframePoint point;
    point.x = (ideal.u - camera.cx) / config.fx;
    point.y = (ideal.v - camera.cy) / config.fy;
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) point.x = point.y = 0.0;
    point.readout_share = readout.fraction(p.u_px, p.v_px);
    point.region = p.region;
    const KeyframeRegion& region = about[p.region];
    if (!region.background) point.inverse_depth = 1.0 / config.distance_mm;
    if (region.background && region.kind == KeyframeRegion::Kind::kStatic)
      point.inverse_depth = 1e-3 / regions[p.region].depth_m;
    points.push_back(point);
  }
  return {config, points, about, static_cast<double>(keyframe.t_start_ns) * 1e-9};
}

}  // namespace core
