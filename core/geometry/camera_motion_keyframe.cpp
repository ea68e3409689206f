// What the keyframe says of every point and region.
#include "core/geometry/camera_motion.h"

#include <Eigen/Geometry>

namespace core {

namespace {

// The regions' own motions, in every frame: shares of the distance, rad, relative zoom.
constexpr double kSlide = 1e3, kSlidePerReadout = 10.0, kTilt_rad = 1.0, kZoom = 0.2;

}  // namespace

// c: of all points in the structure's plane alike; of each far region its own.
void CameraMotion::place_middles(const std::vector<KeyframePoint>& points) {
  std::vector<Eigen::Vector3d> own(regions_.size(), Eigen::Vector3d::Zero());
  std::vector<double> count(regions_.size(), 0.0);
  Eigen::Vector3d structure = Eigen::Vector3d::Zero();  // mm
  double n_structure = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    own[points[i].region] += points_[i].ray;
    count[points[i].region] += 1.0;
    if (!in_plane(points_[i])) continue;
    structure += points_[i].ray / points_[i].inverse_depth;
    n_structure += 1.0;
  }
  if (n_structure > 0.0) structure /= n_structure;
  if (structure.z() > 0.0) middle_ = structure / structure.z();
  for (MotionPoint& p : points_) {
    p.middle =
        in_plane(p) ? Eigen::Vector3d(p.inverse_depth * structure) : Eigen::Vector3d(own[p.region] / count[p.region]);
  }
}

// Background has a middle of its own, known depth or not.
bool CameraMotion::in_plane(const MotionPoint& point) const noexcept {
  return point.inverse_depth > 0.0 && !regions_[point.region].about.background;
}

void CameraMotion::add_own_columns(const std::vector<KeyframePoint>& points) {
  for (std::size_t r = 0; r < regions_.size(); ++r) {
    MotionRegion& region = regions_[r];
    const auto of_region = [&](std::size_t i) { return points_[i].region == r; };
    Eigen::Vector3d ray = Eigen::Vector3d::Zero();
    double share = 0.0, count = 0.0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (!of_region(i)) continue;
      ray += points_[i].ray, share += points[i].readout_share, count += 1.0;
    }
    if (count > 0.0) ray /= count, share /= count;
    region.share = share;
    const auto add = [&](double sd, const auto& column) {
      region.prior_sd(region.n_own) = sd;
      for (std::size_t i = 0; i < points_.size(); ++i) {
        if (of_region(i)) points_[i].own.col(region.n_own) = column(i);
      }
      ++region.n_own;
    };
    const auto from_middle = [&](std::size_t i) { return Eigen::Vector3d(points_[i].ray - ray); };
    const double d = config_.distance_mm;
    if (region.about.kind == KeyframeRegion::Kind::kMoving) {
      for (int a = 0; a < region.about.n_axes; ++a) {
        const Eigen::Vector3d axis = region.about.axis[static_cast<std::size_t>(a)];
        add(kSlide * d, [&](std::size_t i) { return Eigen::Vector3d(points_[i].inverse_depth * axis); });
        region.by_row[static_cast<std::size_t>(region.n_own)] = true;
        add(kSlidePerReadout * d, [&](std::size_t i) { return Eigen::Vector3d(points_[i].inverse_depth * axis); });
      }
      add(kTilt_rad, [&](std::size_t i) { return region.about.normal.cross(from_middle(i)); });
    } else if (region.about.kind == KeyframeRegion::Kind::kFar) {
      add(kZoom, from_middle);
    }
  }
}

}  // namespace core
