#include "core/geometry/motion_keyframe.h"

#include <Eigen/Geometry>

namespace core {
namespace {

// Prior of the regions' own motions in every frame: shares of the distance, rad, relative zoom.
constexpr double kSlide = 1e3, kSlidePerReadout = 10.0, kTilt_rad = 1.0, kZoom = 0.2;

// False for background, which has a centre of its own, whether its depth is known or not.
bool in_plane(const MotionKeyframe& keyframe, const MotionPoint& point) noexcept {
  return point.inverse_depth > 0.0 && !keyframe.regions[point.region].about.background;
}

// Sets c: common to all points in the structure's plane; for each far region its own.
void place_middles(const std::vector<KeyframePoint>& points, MotionKeyframe& out) {
  std::vector<Eigen::Vector3d> own(out.regions.size(), Eigen::Vector3d::Zero());
  std::vector<double> count(out.regions.size(), 0.0);
  Eigen::Vector3d structure = Eigen::Vector3d::Zero();  // mm
  double n_structure = 0.0;
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    own[points[i].region] += out.points[i].ray;
    count[points[i].region] += 1.0;
    if (!in_plane(out, out.points[i])) continue;
    structure += out.points[i].ray / out.points[i].inverse_depth;
    n_structure += 1.0;
  }
  if (n_structure > 0.0) structure /= n_structure;
  if (structure.z() > 0.0) out.middle = structure / structure.z();
  for (MotionPoint& p : out.points) {
    p.middle = in_plane(out, p) ? Eigen::Vector3d(p.inverse_depth * structure)
                                : Eigen::Vector3d(own[p.region] / count[p.region]);
  }
}

void add_own_columns(const std::vector<KeyframePoint>& points, double distance_mm, MotionKeyframe& out) {
  for (std::size_t r = 0; r < out.regions.size(); ++r) {
    MotionRegion& region = out.regions[r];
    const auto of_region = [&](std::size_t i) { return out.points[i].region == r; };
    Eigen::Vector3d ray = Eigen::Vector3d::Zero();
    double share = 0.0, count = 0.0;
    for (std::size_t i = 0; i < out.points.size(); ++i) {
      if (!of_region(i)) continue;
      ray += out.points[i].ray, share += points[i].readout_share, count += 1.0;
    }
    if (count > 0.0) ray /= count, share /= count;
    region.share = share;
    const auto add = [&](double sd, const auto& column) {
      region.prior_sd(region.n_own) = sd;
      for (std::size_t i = 0; i < out.points.size(); ++i) {
        if (of_region(i)) out.points[i].own.col(region.n_own) = column(i);
      }
      ++region.n_own;
    };
    const auto from_middle = [&](std::size_t i) { return Eigen::Vector3d(out.points[i].ray - ray); };
    const double d = distance_mm;
    if (region.about.kind == KeyframeRegion::Kind::kMoving) {
      for (int a = 0; a < region.about.n_axes; ++a) {
        const Eigen::Vector3d axis = region.about.axis[static_cast<std::size_t>(a)];
        add(kSlide * d, [&](std::size_t i) { return Eigen::Vector3d(out.points[i].inverse_depth * axis); });
        region.by_row[static_cast<std::size_t>(region.n_own)] = true;
        add(kSlidePerReadout * d, [&](std::size_t i) { return Eigen::Vector3d(out.points[i].inverse_depth * axis); });
      }
      add(kTilt_rad, [&](std::size_t i) { return region.about.normal.cross(from_middle(i)); });
    } else if (region.about.kind == KeyframeRegion::Kind::kFar) {
      add(kZoom, from_middle);
    }
  }
}

}  // namespace

MotionKeyframe motion_keyframe(const std::vector<KeyframePoint>& points, const std::vector<KeyframeRegion>& regions,
                               double distance_mm) {
  MotionKeyframe out;
  for (const KeyframeRegion& region : regions) out.regions.push_back({.about = region});
  for (const KeyframePoint& point : points) {
    MotionPoint p;
    p.ray = {point.x, point.y, 1.0};
    p.inverse_depth = point.inverse_depth;
    p.region = point.region;
    out.points.push_back(p);
  }
  place_middles(points, out);
  add_own_columns(points, distance_mm, out);
  return out;
}

}  // namespace core
