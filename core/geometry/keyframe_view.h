#pragma once

#include <optional>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/camera_motion.h"
#include "core/geometry/plane_pose.h"
#include "core/geometry/rolling_shutter.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace core {

// Whether the camera's motion can be told from the structure's: a focal length, and something that rests. Without it
// what a structure does by itself passes for motion of the camera (a bending cantilever's tilt for roll).
[[nodiscard]] bool tells_camera_motion(const std::vector<Region>& regions, const CameraModel& camera) noexcept;

// The estimator for what the first frame shows: structure, base and ground in a plane that faces the camera at
// fx * scale_mm_per_px, or lies as `plane` says, background at its region's depth_m, or far. The
// camera is calibrated, and something rests (tells_camera_motion).
[[nodiscard]] CameraMotion make_camera_motion(const std::vector<Region>& regions, const CameraModel& camera,
                                              const ReadoutModel& readout, double scale_mm_per_px,
                                              const TrackFrame& keyframe,
                                              const std::optional<PlanePose>& plane = std::nullopt);

// Unit vector of the axis that a region moves along (Region::axis_deg).
[[nodiscard]] Vector2 axis_of(const Region& region) noexcept;

}  // namespace core
