#pragma once

#include <Eigen/Core>

#include "core/simulation/camera/projection.h"
#include "core/simulation/render/render_line.h"
#include "core/simulation/render/texture.h"
#include "core/simulation/scene_motion.h"

namespace core::simulation {

// Drawing for arbitrary viewing directions and lenses: every pixel's ray is intersected with the plane.

// A plane as the camera sees it at one instant: `cells` times (ray x, ray y, 1) is x, y (in the texture's cells) and 1,
// up to a common factor that is positive where the ray meets the plane.
struct PlaneView {
  Eigen::Matrix3d cells;
  bool in_front;  // false: behind the camera and invisible

  // Origin of the cells: centre of a plate that has moved and rotated; for the background the world's origin.
  PlaneView(const CameraPose& camera, PlanePoint centre, double tilt_rad, double depth_mm, double pitch_mm) noexcept;
};

// Rays of the pixels of a line.
struct LineRays {
  const double *x, *y;  // as RayMap gives them, and the last one Texture::kLook times more
  int length;
  double ray_per_px;                          // 1 / (alpha zoom)
  const LensParameters* lens;                 // through which they came
  double middle_x, middle_y, half_x, half_y;  // box around them, some pixels wider

  LineRays(const double* ray_x, const double* ray_y, int n, const CameraParameters& camera, double zoom) noexcept;
};

// Computes light[u] for u in [begin, end), whole blocks of Texture::kLook; `begin` is a multiple of it. Exact if the
// texture's pitch is at least 1.5 px in the image; below, its contrast decreases to zero at 1 px and beyond the
// horizon.
void draw_plane(const PlaneView& view, const Texture& texture, const LineRays& rays, int begin, int end,
                float* light) noexcept;

// The pixels that a plate of 2 half_x by 2 half_y cells covers: begin is a multiple of Texture::kLook.
struct PixelRange {
  int begin = 0, end = 0;
};
// Fills cover[u] for u in the range returned. The share of a pixel is exact if it contains one edge that is straight in
// the image, or two opposite ones. In a pixel with a corner the shares are multiplied: exact for a plate that is
// upright in the image; the error of a rotated right angle is at most 0.025 of the pixel.
PixelRange cover_plate(const PlaneView& view, double half_x, double half_y, const LineRays& rays,
                       float* cover) noexcept;

// Share of a unit pixel on the positive side of a straight edge: its centre lies distance_px inside, normal_x and
// normal_y are the edge's unit normal.
[[nodiscard]] double half_plane_share(double distance_px, double normal_x, double normal_y) noexcept;

}  // namespace core::simulation
