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

SceneMotion::SceneMotion(const Scene& scene)
    : scene_(validated(scene)), structure_(scene_), camera_(scene_), own_(scene_), warp_(scene_, camera_) {}

double SceneMotion::line_time_s(double t_frame_s, ImagePoint image) const noexcept {
  const CameraParameters& camera = scene_.camera;
  return t_frame_s + camera.readout_s * readout_share(camera, image) + 0.5 * camera.exposure_s;
}

double SceneMotion::exposure_offset_s() const noexcept { return scene_.camera.exposure_s / (2.0 * std::sqrt(3.0)); }

double SceneMotion::depth_mm(int body) const noexcept {
  return body == kBackgroundBody ? scene_.background.depth_mm : scene_.plates[static_cast<std::size_t>(body)].z_mm;
}

BodyPose SceneMotion::body_at(int body, double t_s) const noexcept {
  if (body == kBackgroundBody) return {own_.sway_mm(t_s), 0.0, 0.0};
  const double shift_mm = structure_.displacement_mm(body, t_s);
  const bool along_x = scene_.structure.axis == StructureModel::Axis::kX;
  BodyPose pose{along_x ? shift_mm : 0.0, along_x ? 0.0 : shift_mm, structure_.tilt_rad(body, t_s)};
  if (!own_.rocks()) return pose;
  const double turn_rad = own_.rocking_rad(t_s), c = std::cos(turn_rad), s = std::sin(turn_rad);
  const Plate &plate = scene_.plates[static_cast<std::size_t>(body)], &base = scene_.plates[0];
  const double x_mm = plate.x_mm + pose.x_mm - base.x_mm, y_mm = plate.y_mm + pose.y_mm - base.y_mm;
  pose.x_mm = base.x_mm + c * x_mm - s * y_mm - plate.x_mm;
  pose.y_mm = base.y_mm + s * x_mm + c * y_mm - plate.y_mm;
  pose.tilt_rad += turn_rad;
  return pose;
}

SceneMotion::Place SceneMotion::place_at(int body, PlanePoint point, double t_s) const noexcept {
  const BodyPose pose = body_at(body, t_s);
  if (body == kBackgroundBody) return {pose.x_mm + point.x_mm, pose.y_mm + point.y_mm, depth_mm(body)};
  const Plate& plate = scene_.plates[static_cast<std::size_t>(body)];
  double x_mm = point.x_mm, y_mm = point.y_mm;
  if (body == scene_.flap.body && x_mm > (scene_.flap.from_share - 0.5) * plate.width_mm) {
    const bool along_x = scene_.structure.axis == StructureModel::Axis::kX;
    (along_x ? x_mm : y_mm) += own_.flap_mm(t_s);
  }
  const double torsion_rad = own_.torsion_rad(t_s) * body / (scene_.n_bodies() - 1);
  const double ahead_mm = x_mm * std::sin(torsion_rad);
  x_mm *= std::cos(torsion_rad);
  const double c = std::cos(pose.tilt_rad), s = std::sin(pose.tilt_rad);
  return {plate.x_mm + pose.x_mm + c * x_mm - s * y_mm, plate.y_mm + pose.y_mm + s * x_mm + c * y_mm,
          plate.z_mm + ahead_mm};
}

ImagePoint SceneMotion::see_at(int body, PlanePoint point, double t_s) const noexcept {
  const Place place = place_at(body, point, t_s);
  return project(scene_.camera, camera_.at(t_s), place.x_mm, place.y_mm, place.z_mm);
}

ImagePoint SceneMotion::see(int body, PlanePoint point, double t_frame_s) const noexcept {
  // Newton's method on the time of the point's own line, with its velocity from the instants before and after the
  // middle.
  constexpr int kRounds = 8;
  constexpr double kEnough_px = 1e-6;  // size of the last step; the remaining error is a thousandth of it
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
  return warp_.apply(image, t_s, t_frame_s);
}

PlanePoint SceneMotion::material_point(int body, ImagePoint image, double t_frame_s) const noexcept {
  const double t_s = line_time_s(t_frame_s, image);
  const PlanePoint point = back_project(scene_.camera, camera_.at(t_s), image, depth_mm(body));
  const BodyPose pose = body_at(body, t_s);
  if (body == kBackgroundBody) return {point.x_mm - pose.x_mm, point.y_mm - pose.y_mm};
  const Plate& plate = scene_.plates[static_cast<std::size_t>(body)];
  const double x_mm = point.x_mm - plate.x_mm - pose.x_mm, y_mm = point.y_mm - plate.y_mm - pose.y_mm;
  const double c = std::cos(pose.tilt_rad), s = std::sin(pose.tilt_rad);
  return {c * x_mm + s * y_mm, -s * x_mm + c * y_mm};
}

}  // namespace core::simulation
