#pragma once

#include <optional>

#include "core/geometry/camera_model.h"

namespace core {

// Point at which a distortion folds the image: two rays reach one pixel, and points there cannot be undistorted.
struct LensFault {
  Vector2 raw_px;          // nearest to the axis
  double radius_px = 0.0;  // from the principal point, in the raw image
  double angle_deg = 0.0;  // angle between its ray and the axis
};

// Follows rays from the axis outwards in all directions until they leave the image (widened to include the principal
// point): the determinant of the distortion's Jacobian must stay positive, i.e. for radial distortion the radius must
// increase. Stops at 89 degrees off the axis. nullopt: no fault, or not calibrated.
[[nodiscard]] std::optional<LensFault> lens_fault(const CameraModel& camera, int width_px, int height_px) noexcept;

}  // namespace core
