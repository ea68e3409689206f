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

// Whether camera motion is distinguishable from structural motion: needs a focal length and a static region. Otherwise
// motion of the structure passes for camera motion (a bending cantilever's tilt for roll).
[[nodiscard]] bool tells_camera_motion(const std::vector<Region>& regions, const CameraModel& camera) noexcept;

// The estimator for the view of the first frame: structure, base and ground in a plane that faces the camera at
// distance fx * scale_mm_per_px, or has the pose `plane`; background at its region's depth_m, or infinitely far. Needs
// a calibrated camera and a static region (tells_camera_motion).
[[nodiscard]] CameraMotionEstimator make_camera_motion(const std::vector<Region>& regions, const CameraModel& camera,
                                                       const ReadoutModel& readout, double scale_mm_per_px,
                                                       const TrackFrame& keyframe,
                                                       const std::optional<PlanePose>& plane = std::nullopt);

// Unit vector of the axis along which a region moves (Region::axis_deg).
[[nodiscard]] Vector2 axis_of(const Region& region) noexcept;

}  // namespace core
