#pragma once

#include <cstdint>
#include <span>

#include "core/types/vector2.h"

namespace core {

// Points of one static region, undistorted px: present, in the keyframe, and whether each is seen at present.
struct RestingPoints {
  std::span<const Vector2> position, keyframe;
  std::span<const std::uint8_t> seen;
};

// Motion of each point since the keyframe without the region's own zoom and rotation in the image plane, both about its
// keyframe centre (least squares over the inliers). A static region at another distance than the structure has another
// zoom, and its points share one motion only after its removal. Inliers are found by mlesac_translation(), with
// sigma_px. The motion of unseen points is undefined. Returns the rotation, rad, from u towards v. Does not allocate.
double follow_resting_region(const RestingPoints& points, double sigma_px, std::span<Vector2> motion,
                             std::span<std::uint8_t> inlier) noexcept;

}  // namespace core
