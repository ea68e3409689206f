#include "core/simulation/scene_motion.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace core::simulation {
namespace {

const Scene& validated(const Scene& scene) {
  validate(scene);
  return scene;
}

// Rectangle that holds the plate's inner part in frame 0, in whole pixels.
core::Region plate_region(const SceneMotion& motion, int body) {
  const PlateParameters& plates = motion.scene().plates;
  const double y_mm = motion.scene().body_y_mm(body);
  const ImagePoint a = motion.see(body, {-plates.width_mm / 2, y_mm - plates.height_mm / 2}, 0.0);
  const ImagePoint b = motion.see(body, {plates.width_mm / 2, y_mm + plates.height_mm / 2}, 0.0);
  const double margin = std::min(12.0, 0.22 * (b.v_px - a.v_px));
  core::Region region;
  region.u_px = std::ceil(a.u_px + margin);
  region.v_px = std::ceil(a.v_px + margin);
  region.width_px = std::floor(b.u_px - margin) - region.u_px;
  region.height_px = std::floor(b.v_px - margin) - region.v_px;
  return region;
}

// Left of the structure, clear of it by four standard deviations of the drift.
core::Region background_region(const SceneMotion& motion, const core::Region& plate) {
  const Scene& scene = motion.scene();
  const double scale = scene.camera.alpha_px / scene.plates.depth_mm;
  const double margin = 0.02 * scene.camera.width_px;
  core::Region region;
  region.name = "background";
  region.role = core::RegionRole::kBackground;
  region.u_px = std::ceil(margin + 2.0 * scale * scene.hover.x_rms_mm);
  region.v_px = std::ceil(0.3 * scene.camera.height_px);
  region.width_px = std::floor(plate.u_px - scale * (4.0 * scene.hover.x_rms_mm + 20.0)) - region.u_px;
  region.height_px = std::floor(0.4 * scene.camera.height_px);
  return region;
}

}  // namespace

SceneMotion::SceneMotion(const Scene& scene)
    : scene_(validated(scene)),
      structure_(scene.structure, scene.seed, scene.duration_s),
      hover_(scene.hover, scene.seed, scene.duration_s) {}

double SceneMotion::frame_time_s(std::uint64_t frame) const noexcept {
  return static_cast<double>(frame) / scene_.camera.rate_hz;
}

double SceneMotion::row_time_s(double t_frame_s, double v_px) const noexcept {
  return t_frame_s + scene_.camera.readout_s * v_px / scene_.camera.height_px + 0.5 * scene_.camera.exposure_s;
}

double SceneMotion::depth_mm(int body) const noexcept {
  return body == kBackgroundBody ? scene_.background.depth_mm : scene_.plates.depth_mm;
}

ImagePoint SceneMotion::see(int body, PlanePoint point, double t_frame_s) const noexcept {
  // The row's time changes the row by readout / height * velocity, at most a few thousandths: six rounds leave nothing.
  constexpr int kRounds = 6;
  ImagePoint image{scene_.camera.cx_px, scene_.camera.cy_px};
  for (int i = 0; i < kRounds; ++i) {
    const double t_s = row_time_s(t_frame_s, image.v_px);
    const double shift_mm = body == kBackgroundBody ? 0.0 : structure_.displacement_mm(body, t_s);
    image = project(scene_.camera, hover_.at(t_s), point.x_mm + shift_mm, point.y_mm, depth_mm(body));
  }
  return image;
}

PlanePoint SceneMotion::material_point(int body, ImagePoint image, double t_frame_s) const noexcept {
  const double t_s = row_time_s(t_frame_s, image.v_px);
  PlanePoint point = back_project(scene_.camera, hover_.at(t_s), image, depth_mm(body));
  if (body != kBackgroundBody) point.x_mm -= structure_.displacement_mm(body, t_s);
  return point;
}

std::vector<std::string> body_names(const Scene& scene) {
  std::vector<std::string> names{"base"};
  for (int floor = 1; floor <= scene.structure.n_floors(); ++floor) names.push_back("floor" + std::to_string(floor));
  return names;
}

std::vector<SceneRegion> tracking_regions(const SceneMotion& motion) {
  const std::vector<std::string> names = body_names(motion.scene());
  std::vector<SceneRegion> regions;
  for (int i = 1; i <= motion.scene().n_bodies(); ++i) {
    const int body = i % motion.scene().n_bodies();  // floors first, the base last
    core::Region region = plate_region(motion, body);
    region.name = names[static_cast<std::size_t>(body)];
    region.role = body == 0 ? core::RegionRole::kBase : core::RegionRole::kStructure;
    regions.push_back({body, region});
  }
  core::Region background = background_region(motion, regions.front().region);
  if (background.width_px >= 20.0) regions.push_back({kBackgroundBody, background});
  return regions;
}

}  // namespace core::simulation
