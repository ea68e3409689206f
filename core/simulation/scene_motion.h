#pragma once

#include <cstdint>
#include <vector>

#include "core/simulation/hover_motion.h"
#include "core/simulation/projection.h"
#include "core/simulation/scene.h"
#include "core/simulation/structure_response.h"
#include "core/types/region.h"

namespace core::simulation {

// Marks the background wherever a body is asked for.
inline constexpr int kBackgroundBody = -1;

// Everything that moves in a scene, at any time: what renderer, track generator and truth share.
class SceneMotion {
 public:
  explicit SceneMotion(const Scene& scene);  // validates the scene

  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }
  [[nodiscard]] const StructureResponse& structure() const noexcept { return structure_; }
  [[nodiscard]] const HoverMotion& hover() const noexcept { return hover_; }

  [[nodiscard]] double frame_time_s(std::uint64_t frame) const noexcept;  // start of exposure of row 0
  // Middle of the exposure of row v of the frame that starts at t_frame_s.
  [[nodiscard]] double row_time_s(double t_frame_s, double v_px) const noexcept;
  [[nodiscard]] double depth_mm(int body) const noexcept;

  // Where a point fixed to a body (x from the plate's centre, y absolute, both at rest) is in the image: solved for the
  // time at which its own row is exposed.
  [[nodiscard]] ImagePoint see(int body, PlanePoint point, double t_frame_s) const noexcept;
  // The point of a body that stands at this pixel of the frame.
  [[nodiscard]] PlanePoint material_point(int body, ImagePoint image, double t_frame_s) const noexcept;

 private:
  Scene scene_;
  StructureResponse structure_;
  HoverMotion hover_;
};

// What a user would mark in the first frame: floor1 .. floorN, base, background, in this order. Rectangles lie inside
// their plates, far enough from the edges that a tracking window sees little else.
struct SceneRegion {
  int body;  // kBackgroundBody, or as in SceneMotion
  core::Region region;
};
[[nodiscard]] std::vector<SceneRegion> tracking_regions(const SceneMotion& motion);

// The names in body order: base, floor1 .. floorN.
[[nodiscard]] std::vector<std::string> body_names(const Scene& scene);

}  // namespace core::simulation
