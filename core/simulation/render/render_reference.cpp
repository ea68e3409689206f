#include "core/simulation/render/render_reference.h"

#include <cmath>

#include "core/simulation/render/render_textures.h"

namespace core::simulation {

RenderReference::RenderReference(const Scene& scene)
    : motion_(scene), light_(scene), background_(background_texture(scene)), plate_(plate_textures(scene)) {}

RenderReference::Instant RenderReference::instant_at(double t_s) const {
  Instant instant{motion_.camera().at(t_s), {}};
  for (int body = 0; body < motion_.scene().n_bodies(); ++body) instant.bodies.push_back(motion_.body_at(body, t_s));
  return instant;
}

PlanePoint RenderReference::place(int body, ImagePoint image, double t_s) const {
  return place(body, image, instant_at(t_s));
}

PlanePoint RenderReference::place(int body, ImagePoint image, const Instant& instant) const {
  const Scene& scene = motion_.scene();
  const PlanePoint world = back_project(scene.camera, instant.camera, image, motion_.depth_mm(body));
  if (body == kBackgroundBody) return world;
  const Plate& plate = scene.plates[static_cast<std::size_t>(body)];
  const BodyPose& pose = instant.bodies[static_cast<std::size_t>(body)];
  const double x_mm = world.x_mm - plate.x_mm - pose.x_mm, y_mm = world.y_mm - plate.y_mm - pose.y_mm;
  const double c = std::cos(pose.tilt_rad), s = std::sin(pose.tilt_rad);
  return {c * x_mm + s * y_mm, c * y_mm - s * x_mm};
}

double RenderReference::texture(int body, PlanePoint point) const {
  const Texture& of = body == kBackgroundBody ? background_ : plate_[static_cast<std::size_t>(body)];
  return of.value(point.x_mm, point.y_mm);
}

int RenderReference::seen_body(ImagePoint image, const Instant& instant) const {
  const std::vector<Plate>& plates = motion_.scene().plates;
  int nearest = kBackgroundBody;
  for (int body = 0; body < motion_.scene().n_bodies(); ++body) {
    const Plate& plate = plates[static_cast<std::size_t>(body)];
    const PlanePoint point = place(body, image, instant);
    if (std::abs(point.x_mm) > 0.5 * plate.width_mm || std::abs(point.y_mm) > 0.5 * plate.height_mm) continue;
    if (nearest == kBackgroundBody || plate.z_mm < motion_.depth_mm(nearest)) nearest = body;
  }
  return nearest;
}

double RenderReference::grey(double t_frame_s, int u, int v, int instants, int points) const {
  const ImagePoint centre{static_cast<double>(u), static_cast<double>(v)};
  const double middle_s = motion_.line_time_s(t_frame_s, centre);
  double sum = 0.0;
  for (int k = 0; k < instants; ++k) {
    const Instant instant = instant_at(middle_s + ((k + 0.5) / instants - 0.5) * motion_.scene().camera.exposure_s);
    for (int i = 0; i < points; ++i) {
      const double along = (i + 0.5) / points, golden = i * 0.6180339887498949 + 0.5;
      const int body = seen_body({u + along - 0.5, v + golden - std::floor(golden) - 0.5}, instant);
      sum += texture(body, place(body, centre, instant));
    }
  }
  return light_.factor(middle_s) * sum / (instants * points);
}

}  // namespace core::simulation
