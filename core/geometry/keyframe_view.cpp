#include "core/geometry/keyframe_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace core {

namespace {

KeyframeRegion keyframe_region(const Region& region) {
  KeyframeRegion out;
  out.background = region.role == RegionRole::kBackground;
  if (!makes_channel(region.role)) {
    const bool far = out.background && !(region.depth_m > 0.0);
    out.kind = far ? KeyframeRegion::Kind::kFar : KeyframeRegion::Kind::kStatic;
    return out;
  }
  const double angle = region.axis_deg * std::numbers::pi / 180.0;
  out.n_axes = region.both_axes ? 2 : 1;
  if (!region.both_axes) out.axis[0] = {std::cos(angle), std::sin(angle), 0.0};
  return out;
}

// Replaces axes that differ only by drawing errors or perspective by one common axis: otherwise their differences would
// seem to determine the translation along them.
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

// Inverse depth of a point in the structure's plane.
double inverse_depth(const std::optional<PlanePose>& plane, const Vector2& ideal_px, double distance_mm) noexcept {
  const auto place = plane ? plane->place_at(ideal_px) : std::nullopt;
  if (!place) return 1.0 / distance_mm;
  const double z_mm =
      plane->rotation(2, 0) * place->x_mm + plane->rotation(2, 1) * place->y_mm + plane->translation_mm.z();
  return z_mm > 0.0 ? 1.0 / z_mm : 1.0 / distance_mm;
}

// Direction in space of a motion along an image direction, where the plane meets this pixel.
Eigen::Vector3d axis_in_plane(const PlanePose& plane, const Vector2& ideal_px, const Eigen::Vector3d& image_axis) {
  const auto place = plane.place_at(ideal_px);
  if (!place) return image_axis;
  const Eigen::Vector2d mm = plane.px_per_mm(*place).inverse() * image_axis.head<2>();
  const Eigen::Vector3d axis = plane.rotation.leftCols<2>() * mm;
  return axis.allFinite() && axis.norm() > 0.0 ? Eigen::Vector3d(axis.normalized()) : image_axis;
}

}  // namespace

bool tells_camera_motion(const std::vector<Region>& regions, const CameraModel& camera) noexcept {
  return camera.calibrated() &&
         std::any_of(regions.begin(), regions.end(), [](const Region& region) { return !makes_channel(region.role); });
}

CameraMotionEstimator make_camera_motion(const std::vector<Region>& regions, const CameraModel& camera,
                                         const ReadoutModel& readout, double scale_mm_per_px,
                                         const TrackFrame& keyframe, const std::optional<PlanePose>& plane) {
  CameraMotionConfig config;
  config.fx = camera.fx;
  config.fy = camera.fy;
  config.readout_s = readout.readout_s;
  const double scale = std::isfinite(scale_mm_per_px) && scale_mm_per_px > 0.0 ? scale_mm_per_px : 1.0;
  config.distance_mm = 0.5 * (config.fx + config.fy) * scale;

  std::vector<KeyframeRegion> about;
  for (const Region& region : regions) {
    about.push_back(keyframe_region(region));
    if (!plane || region.role == RegionRole::kBackground) continue;
    const Vector2 middle =
        camera.undistort({region.u_px + 0.5 * region.width_px, region.v_px + 0.5 * region.height_px});
    for (Eigen::Vector3d& axis : about.back().axis) axis = axis_in_plane(*plane, middle, axis);
    about.back().normal = -plane->normal();  // pointing away from the camera
  }
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
    if (!region.background) point.inverse_depth = inverse_depth(plane, ideal, config.distance_mm);
    if (region.background && region.kind == KeyframeRegion::Kind::kStatic)
      point.inverse_depth = 1e-3 / regions[p.region].depth_m;
    points.push_back(point);
  }
  return {config, points, about, static_cast<double>(keyframe.t_start_ns) * 1e-9};
}

std::vector<ScaleFactor::Point> scale_points(const std::vector<Region>& regions, const CameraModel& camera,
                                             const TrackFrame& keyframe) {
  std::vector<ScaleFactor::Point> points;
  for (const TrackPoint& p : keyframe.points) {
    const Region& region = regions[p.region];
    const Vector2 axis = axis_of(region);
    points.push_back({camera.undistort({p.u_px, p.v_px}), p.region, axis.u, axis.v, region.both_axes,
                      region.role != RegionRole::kBackground});
  }
  return points;
}

Vector2 axis_of(const Region& region) noexcept {
  const double angle = region.axis_deg * std::numbers::pi / 180.0;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace core
