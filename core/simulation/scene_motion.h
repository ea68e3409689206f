#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/simulation/camera/camera_motion.h"
#include "core/simulation/camera/projection.h"
#include "core/simulation/injected/image_warp.h"
#include "core/simulation/injected/own_motion.h"
#include "core/simulation/scene.h"
#include "core/simulation/structure/structure_response.h"
#include "core/types/region.h"

namespace core::simulation {

// Denotes the background in place of a body.
inline constexpr int kBackgroundBody = -1;

// Pose of a body: its shift from equilibrium and its rotation about its centre, from X towards Y. Contains rocking of
// the whole structure and sway of the background, but not a flapping part or torsion.
struct BodyPose {
  double x_mm = 0.0, y_mm = 0.0, tilt_rad = 0.0;
};

// Everything that moves in a scene, at any time: shared by renderer, track generator and truth.
class SceneMotion {
 public:
  explicit SceneMotion(const Scene& scene);  // validates the scene

  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] const StructureResponse& structure() const noexcept { return structure_; }
  [[nodiscard]] const CameraMotion& camera() const noexcept { return camera_; }
  [[nodiscard]] const OwnMotion& own() const noexcept { return own_; }
  [[nodiscard]] const ImageWarp& warp() const noexcept { return warp_; }

  // Middle of the exposure of the line that holds the pixel, in the frame whose row 0 starts at t_frame_s.
  [[nodiscard]] double line_time_s(double t_frame_s, ImagePoint image) const noexcept;
  // Distance of the two instants whose mean represents the exposure in images (Gauss-Legendre: exact to third order in
  // the motion) from its centre.
  [[nodiscard]] double exposure_offset_s() const noexcept;
  [[nodiscard]] double depth_mm(int body) const noexcept;
  [[nodiscard]] BodyPose body_at(int body, double t_s) const noexcept;

  // Image position of a point fixed to a body, averaged over the exposure (three Gauss-Legendre instants: a sine of f T
  // = 0.5 is reproduced to 0.1 %) and solved for the time at which its own line is exposed. Points are relative to the
  // plate's centre (background: absolute), in the body's own axes.
  [[nodiscard]] ImagePoint see(int body, PlanePoint point, double t_frame_s) const noexcept;
  // The point of a body seen at this pixel of the frame, at the centre of its exposure; without flap, torsion and image
  // effects after projection.
  [[nodiscard]] PlanePoint material_point(int body, ImagePoint image, double t_frame_s) const noexcept;

 private:
  // Position of a point of a body in the world.
  struct Place {
    double x_mm, y_mm, z_mm;
  };
  [[nodiscard]] Place place_at(int body, PlanePoint point, double t_s) const noexcept;
  [[nodiscard]] ImagePoint see_at(int body, PlanePoint point, double t_s) const noexcept;

  Scene scene_;
  StructureResponse structure_;
  CameraMotion camera_;
  OwnMotion own_;
  ImageWarp warp_;
};

// A rectangle to be tracked on each body, in its own axes (background: absolute), clear of the plate's rim. Bodies
// first, then the ground, then the background if there is room beside the structure. Depends on structure and mean view
// alone, so that a scene shows the same points with and without an effect.
struct Mark {
  int body;  // kBackgroundBody, or as in SceneMotion
  PlanePoint low, high;
};
[[nodiscard]] std::vector<Mark> marks_of(const Scene& scene);

// Regions that a user would draw about the marks in the first frame, in their order: rectangles inside the marks.
struct SceneRegion {
  int body;
  core::Region region;
};
[[nodiscard]] std::vector<SceneRegion> tracking_regions(const SceneMotion& motion);

}  // namespace core::simulation
