#include "core/simulation/scene_motion.h"

#include <algorithm>
#include <cmath>

namespace core::simulation {
namespace {

const Scene& validated(const Scene& scene) {
  validate(scene);
  return scene;
}

}  // namespace

SceneMotion::SceneMotion(const Scene& scene) : scene_(validated(scene)), structure_(scene_), camera_(scene_) {}

double SceneMotion::line_time_s(double t_frame_s, ImagePoint image) const noexcept {
  const CameraParameters& camera = scene_.camera;
  return t_frame_s + camera.readout_s * readout_share(camera, image) + 0.5 * camera.exposure_s;
}

double SceneMotion::exposure_offset_s() const noexcept { return scene_.camera.exposure_s / (2.0 * std::sqrt(3.0)); }

double SceneMotion::depth_mm(int body) const noexcept {
  return body == kBackgroundBody ? scene_.background.depth_mm : scene_.plates[static_cast<std::size_t>(body)].z_mm;
}

BodyPose SceneMotion::body_at(int body, double t_s) const noexcept {
  if (body == kBackgroundBody) return {};
  const double shift_mm = structure_.displacement_mm(body, t_s);
  const bool along_x = scene_.structure.axis == StructureModel::Axis::kX;
  return {along_x ? shift_mm : 0.0, along_x ? 0.0 : shift_mm, structure_.tilt_rad(body, t_s)};
}

ImagePoint SceneMotion::see_at(int body, PlanePoint point, double t_s) const noexcept {
  double x_mm = point.x_mm, y_mm = point.y_mm;
  if (body != kBackgroundBody) {
    const BodyPose pose = body_at(body, t_s);
    const Plate& plate = scene_.plates[static_cast<std::size_t>(body)];
    const double c = std::cos(pose.tilt_rad), s = std::sin(pose.tilt_rad);
    x_mm = plate.x_mm + pose.x_mm + c * point.x_mm - s * point.y_mm;
    y_mm = plate.y_mm + pose.y_mm + s * point.x_mm + c * point.y_mm;
  }
  return project(scene_.camera, camera_.at(t_s), x_mm, y_mm, depth_mm(body));
}

ImagePoint SceneMotion::see(int body, PlanePoint point, double t_frame_s) const noexcept {
  // Newton's method on the time of the point's own line, its velocity taken from before to after the middle.
  constexpr int kRounds = 8;
  constexpr double kEnough_px = 1e-6;  // of the last step; what it leaves is a thousandth of it
  constexpr double kLeastStep_s = 1e-4;
  constexpr double kOuterWeight = 5.0 / 18.0;
  const CameraParameters& camera = scene_.camera;
  const double outer_s = 0.5 * camera.exposure_s * std::sqrt(0.6), step_s = std::max(outer_s, kLeastStep_s);
  const double outer_weight = outer_s < step_s ? 0.0 : kOuterWeight, inner_weight = 1.0 - 2.0 * outer_weight;
  double t_s = line_time_s(t_frame_s, see_at(body, point, line_time_s(t_frame_s, {camera.cx_px, camera.cy_px})));
  ImagePoint image;
  for (int i = 0; i < kRounds; ++i) {
    const ImagePoint early = see_at(body, point, t_s - step_s), late = see_at(body, point, t_s + step_s);
    const ImagePoint middle = see_at(body, point, t_s);
    const ImagePoint mean{inner_weight * middle.u_px + outer_weight * (early.u_px + late.u_px),
                          inner_weight * middle.v_px + outer_weight * (early.v_px + late.v_px)};
    const ImagePoint velocity{(late.u_px - early.u_px) / (2.0 * step_s), (late.v_px - early.v_px) / (2.0 * step_s)};
    const double late_s = line_time_s(t_frame_s, mean) - t_s;
    const double dt_s = late_s / (1.0 - camera.readout_s * readout_share(camera, velocity));
    image = {mean.u_px + dt_s * velocity.u_px, mean.v_px + dt_s * velocity.v_px};
    if (std::abs(dt_s) * (std::abs(velocity.u_px) + std::abs(velocity.v_px)) < kEnough_px) break;
    t_s += dt_s;
  }
  return image;
}

PlanePoint SceneMotion::material_point(int body, ImagePoint image, double t_frame_s) const noexcept {
  const double t_s = line_time_s(t_frame_s, image);
  PlanePoint point = back_project(scene_.camera, camera_.at(t_s), image, depth_mm(body));
  if (body == kBackgroundBody) return point;
  const BodyPose pose = body_at(body, t_s);
  const Plate& plate = scene_.plates[static_cast<std::size_t>(body)];
  const double x_mm = point.x_mm - plate.x_mm - pose.x_mm, y_mm = point.y_mm - plate.y_mm - pose.y_mm;
  const double c = std::cos(pose.tilt_rad), s = std::sin(pose.tilt_rad);
  return {c * x_mm + s * y_mm, -s * x_mm + c * y_mm};
}

}  // namespace core::simulation
