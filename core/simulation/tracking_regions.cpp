#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/simulation/scene_motion.h"

namespace core::simulation {
namespace {

constexpr double kClearance = 0.06;  // of the image: four standard deviations of the paper's drift

struct Extent {
  double low, high;
};

// Coordinates of the four corners of a mark in frame 0, ascending.
struct Corners {
  std::array<double, 4> u, v;
  // Between the inner two: a rectangle that lies in the mark.
  [[nodiscard]] Extent inner_u() const { return {u[1], u[2]}; }
  [[nodiscard]] Extent inner_v() const { return {v[1], v[2]}; }
};

Corners corners_of(const SceneMotion& motion, const Mark& mark) {
  Corners corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = (i & 1U) != 0 ? mark.high.x_mm : mark.low.x_mm, y = (i & 2U) != 0 ? mark.high.y_mm : mark.low.y_mm;
    const ImagePoint image = motion.see(mark.body, {x, y}, 0.0);
    corners.u[i] = image.u_px;
    corners.v[i] = image.v_px;
  }
  std::sort(corners.u.begin(), corners.u.end());
  std::sort(corners.v.begin(), corners.v.end());
  return corners;
}

core::Region rectangle(Extent u, Extent v) {
  core::Region region;
  region.u_px = std::ceil(u.low);
  region.v_px = std::ceil(v.low);
  region.width_px = std::floor(u.high) - region.u_px;
  region.height_px = std::floor(v.high) - region.v_px;
  return region;
}

// The structure's axis of motion in the first frame, from +u towards +v, in (-45, 135]: a vertical axis points down for
// any small roll of the camera.
double axis_deg(const SceneMotion& motion, int body) {
  const bool along_x = motion.scene().structure.axis == StructureModel::Axis::kX;
  const ImagePoint a = motion.see(body, {0.0, 0.0}, 0.0);
  const ImagePoint b = motion.see(body, {along_x ? 1.0 : 0.0, along_x ? 0.0 : 1.0}, 0.0);
  double deg = std::atan2(b.v_px - a.v_px, b.u_px - a.u_px) * 180.0 / std::numbers::pi;
  if (deg <= -45.0) deg += 180.0;
  if (deg > 135.0) deg -= 180.0;
  return std::abs(deg) < 1e-9 ? 0.0 : deg;
}

// A plate without its rim of 12 px, or of 0.22 of its shorter side if that is less.
Mark plate_mark(const Scene& scene, int body) {
  const Plate& plate = scene.plates[static_cast<std::size_t>(body)];
  const double px_mm = (plate.z_mm - scene.camera.z_mm) / scene.camera.alpha_px;
  const double rim_mm = std::min(12.0 * px_mm, 0.22 * std::min(plate.width_mm, plate.height_mm));
  const double x = 0.5 * plate.width_mm - rim_mm, y = 0.5 * plate.height_mm - rim_mm;
  return {body, {-x, -y}, {x, y}};
}

// Projection with the camera at its mean pose and without lens: marks do not depend on disturbances of the view.
ImagePoint see_undisturbed(const Scene& scene, double x_mm, double y_mm, double z_mm) {
  CameraParameters camera = scene.camera;
  camera.lens = {};
  const CameraPose pose{camera.x_mm, camera.y_mm, camera.z_mm,
                        attitude(camera.pitch_rad, camera.yaw_rad, camera.roll_rad)};
  return project(camera, pose, x_mm, y_mm, z_mm);
}

// Rectangle beside the structure, clear of it and of the image's edge: left of it if there is room, else the largest of
// the other three sides. Width 0: no room.
core::Region free_rectangle(const Scene& scene) {
  double low_u = 1e18, high_u = -1e18, low_v = 1e18, high_v = -1e18;
  for (const Plate& plate : scene.plates) {
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        const ImagePoint corner =
            see_undisturbed(scene, plate.x_mm + x * plate.width_mm, plate.y_mm + y * plate.height_mm, plate.z_mm);
        low_u = std::min(low_u, corner.u_px), high_u = std::max(high_u, corner.u_px);
        low_v = std::min(low_v, corner.v_px), high_v = std::max(high_v, corner.v_px);
      }
    }
  }
  const double width = scene.camera.width_px, height = scene.camera.height_px;
  const double clear_u = kClearance * width, clear_v = kClearance * height;
  const Extent middle_u{0.3 * width, 0.7 * width}, middle_v{0.3 * height, 0.7 * height};
  const std::array<core::Region, 4> sides{
      rectangle({clear_u, low_u - clear_u}, middle_v), rectangle({high_u + clear_u, width - clear_u}, middle_v),
      rectangle(middle_u, {clear_v, low_v - clear_v}), rectangle(middle_u, {high_v + clear_v, height - clear_v})};
  const auto room = [](const core::Region& r) {
    return std::min(r.width_px, r.height_px) < 20.0 ? 0.0 : r.width_px * r.height_px;
  };
  if (room(sides[0]) > 0.0) return sides[0];
  const core::Region best =
      *std::max_element(sides.begin(), sides.end(), [&](const auto& a, const auto& b) { return room(a) < room(b); });
  return room(best) > 0.0 ? best : core::Region{};
}

Mark background_mark(const Scene& scene, const core::Region& free) {
  CameraParameters camera = scene.camera;
  camera.lens = {};
  const CameraPose pose{camera.x_mm, camera.y_mm, camera.z_mm,
                        attitude(camera.pitch_rad, camera.yaw_rad, camera.roll_rad)};
  const double depth_mm = scene.background.depth_mm;
  const PlanePoint a = back_project(camera, pose, {free.u_px, free.v_px}, depth_mm);
  const PlanePoint b = back_project(camera, pose, {free.u_px + free.width_px, free.v_px + free.height_px}, depth_mm);
  return {kBackgroundBody,
          {std::min(a.x_mm, b.x_mm), std::min(a.y_mm, b.y_mm)},
          {std::max(a.x_mm, b.x_mm), std::max(a.y_mm, b.y_mm)}};
}

}  // namespace

std::vector<Mark> marks_of(const Scene& scene) {
  std::vector<Mark> marks;
  for (int i = 1; i <= scene.n_bodies(); ++i) marks.push_back(plate_mark(scene, i % scene.n_bodies()));
  const core::Region free = free_rectangle(scene);
  if (free.width_px > 0.0) marks.push_back(background_mark(scene, free));
  return marks;
}

std::vector<SceneRegion> tracking_regions(const SceneMotion& motion) {
  std::vector<SceneRegion> regions;
  for (const Mark& mark : marks_of(motion.scene())) {
    const Corners corners = corners_of(motion, mark);
    core::Region region = rectangle(corners.inner_u(), corners.inner_v());
    region.axis_deg = axis_deg(motion, mark.body);
    if (mark.body == kBackgroundBody) {
      region.name = "background";
      region.role = core::RegionRole::kBackground;
    } else {
      region.name = motion.scene().plates[static_cast<std::size_t>(mark.body)].name;
      region.role = mark.body == 0 ? core::RegionRole::kBase : core::RegionRole::kStructure;
    }
    regions.push_back({mark.body, region});
  }
  return regions;
}

}  // namespace core::simulation
