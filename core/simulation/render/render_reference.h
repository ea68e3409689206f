#pragma once

#include <vector>

#include "core/simulation/camera/light.h"
#include "core/simulation/render/texture.h"
#include "core/simulation/scene_motion.h"

namespace core::simulation {

// Reference for the renderer's pixels, by brute force and independently of it: each pixel is projected back separately
// through projection.h, in double precision. Slow; for tests. Textures are those of the renderer.
class RenderReference {
 public:
  explicit RenderReference(const Scene& scene);

  // Grey level: the mean over `instants` of the exposure, evenly spaced, of the plates' textures at the pixel's centre,
  // each weighted by the share of the pixel's `points` (a lattice over its square; one: its centre) that see it.
  [[nodiscard]] double grey(double t_frame_s, int u, int v, int instants, int points) const;

  // The point of a body (in its own axes) seen at an image position at an instant, regardless of the plate's edges.
  [[nodiscard]] PlanePoint place(int body, ImagePoint image, double t_s) const;
  [[nodiscard]] double texture(int body, PlanePoint point) const;
  [[nodiscard]] const SceneMotion& motion() const noexcept { return motion_; }

 private:
  // Poses of camera and bodies at an instant.
  struct Instant {
    CameraPose camera;
    std::vector<BodyPose> bodies;
  };
  [[nodiscard]] Instant instant_at(double t_s) const;
  [[nodiscard]] PlanePoint place(int body, ImagePoint image, const Instant& instant) const;
  [[nodiscard]] int seen_body(ImagePoint image, const Instant& instant) const;  // nearest; kBackgroundBody

  SceneMotion motion_;
  Light light_;
  Texture background_;
  std::vector<Texture> plate_;
};

}  // namespace core::simulation
