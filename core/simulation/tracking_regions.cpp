#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/simulation/scene_motion.h"

namespace core::simulation {
namespace {

struct Extent {
  double low, high;
};

// Of the four corners of a plate: between the inner two, so that the rectangle lies in the plate, and over all.
struct Corners {
  std::array<double, 4> u, v;
  [[nodiscard]] Extent inner_u() const { return {u[1], u[2]}; }
  [[nodiscard]] Extent inner_v() const { return {v[1], v[2]}; }
};

Corners corners_of(const SceneMotion& motion, int body) {
  const Plate& plate = motion.scene().plates[static_cast<std::size_t>(body)];
  Corners corners{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double x = (i & 1U) != 0 ? 0.5 : -0.5, y = (i & 2U) != 0 ? 0.5 : -0.5;
    const ImagePoint image = motion.see(body, {x * plate.width_mm, y * plate.height_mm}, 0.0);
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

// The structure's axis of motion as the first frame shows it, from +u towards +v, in (-90, 90].
double axis_deg(const SceneMotion& motion, int body) {
  const bool along_x = motion.scene().structure.axis == StructureModel::Axis::kX;
  const ImagePoint a = motion.see(body, {0.0, 0.0}, 0.0);
  const ImagePoint b = motion.see(body, {along_x ? 1.0 : 0.0, along_x ? 0.0 : 1.0}, 0.0);
  double deg = std::atan2(b.v_px - a.v_px, b.u_px - a.u_px) * 180.0 / std::numbers::pi;
  if (deg <= -90.0) deg += 180.0;
  if (deg > 90.0) deg -= 180.0;
  return std::abs(deg) < 1e-9 ? 0.0 : deg;
}

core::Region plate_region(const SceneMotion& motion, int body) {
  const Corners corners = corners_of(motion, body);
  const auto [low_u, high_u] = corners.inner_u();
  const auto [low_v, high_v] = corners.inner_v();
  const double margin = std::min(12.0, 0.22 * std::min(high_v - low_v, high_u - low_u));
  core::Region region = rectangle({low_u + margin, high_u - margin}, {low_v + margin, high_v - margin});
  region.name = motion.scene().plates[static_cast<std::size_t>(body)].name;
  region.role = body == 0 ? core::RegionRole::kBase : core::RegionRole::kStructure;
  region.axis_deg = axis_deg(motion, body);
  return region;
}

// Beside the structure, clear of it by four standard deviations of the drift: left of it where there is room, else the
// largest of the other three sides.
core::Region background_region(const SceneMotion& motion) {
  const Scene& scene = motion.scene();
  double low_u = 1e18, high_u = -1e18, low_v = 1e18, high_v = -1e18, near_mm = 1e18;
  for (int body = 0; body < scene.n_bodies(); ++body) {
    const Corners corners = corners_of(motion, body);
    low_u = std::min(low_u, corners.u[0]), high_u = std::max(high_u, corners.u[3]);
    low_v = std::min(low_v, corners.v[0]), high_v = std::max(high_v, corners.v[3]);
    near_mm = std::min(near_mm, motion.depth_mm(body) - scene.camera.z_mm);
  }
  const double scale = scene.camera.alpha_px / near_mm;
  const double clear_u = scale * (4.0 * scene.hover.x_rms_mm + 4.0 * scene.excitation.rms_mm);
  const double clear_v = scale * (4.0 * scene.hover.y_rms_mm + 4.0 * scene.excitation.rms_mm);
  const double margin_u = 0.02 * scene.camera.width_px + 2.0 * scale * scene.hover.x_rms_mm;
  const double margin_v = 0.02 * scene.camera.height_px + 2.0 * scale * scene.hover.y_rms_mm;
  const double width = scene.camera.width_px, height = scene.camera.height_px;
  const Extent middle_u{0.3 * width, 0.7 * width}, middle_v{0.3 * height, 0.7 * height};
  const std::array<core::Region, 4> sides{rectangle({margin_u, low_u - clear_u}, middle_v),
                                          rectangle({high_u + clear_u, width - margin_u}, middle_v),
                                          rectangle(middle_u, {margin_v, low_v - clear_v}),
                                          rectangle(middle_u, {high_v + clear_v, height - margin_v})};
  const auto room = [](const core::Region& r) {
    return std::min(r.width_px, r.height_px) < 20.0 ? 0.0 : r.width_px * r.height_px;
  };
  core::Region region = room(sides[0]) > 0.0 ? sides[0] : *std::max_element(sides.begin(), sides.end(), [&](auto& a, auto& b) {
    return room(a) < room(b);
  });
  region.name = "background";
  region.role = core::RegionRole::kBackground;
  region.axis_deg = axis_deg(motion, kBackgroundBody);
  if (room(region) <= 0.0) region.width_px = 0.0;
  return region;
}

}  // namespace

std::vector<SceneRegion> tracking_regions(const SceneMotion& motion) {
  std::vector<SceneRegion> regions;
  for (int i = 1; i <= motion.scene().n_bodies(); ++i) {
    const int body = i % motion.scene().n_bodies();  // the bodies first, the ground last
    regions.push_back({body, plate_region(motion, body)});
  }
  const core::Region background = background_region(motion);
  if (background.width_px > 0.0) regions.push_back({kBackgroundBody, background});
  return regions;
}

}  // namespace core::simulation
