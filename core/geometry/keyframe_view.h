#pragma once

#include <optional>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/camera_motion.h"
#include "core/geometry/plane_pose.h"
#include "core/geometry/rolling_shutter.h"
#include "core/geometry/scale_factor.h"
#include "core/types/region.h"
#include "core/types/track.h"

namespace core {

// True if camera motion can be distinguished from structural motion: this needs a focal length and a static region.
// Otherwise structural motion is mistaken for camera motion (a bending cantilever's tilt for roll).
[[nodiscard]] bool tells_camera_motion(const std::vector<Region>& regions, const CameraModel& camera) noexcept;

// Estimator for the view of the first frame: structure, base and ground lie in a frontal plane at distance fx *
// scale_mm_per_px, or in the plane of pose `plane`; background at its region's depth_m, or infinitely far. Needs a
// calibrated camera and a static region (tells_camera_motion).
[[nodiscard]] CameraMotionEstimator make_camera_motion(const std::vector<Region>& regions, const CameraModel& camera,
                                                       const ReadoutModel& readout, double scale_mm_per_px,
                                                       const TrackFrame& keyframe,
                                                       const std::optional<PlanePose>& plane = std::nullopt);

// Points of the keyframe for the scale per frame.
[[nodiscard]] std::vector<ScaleFactor::Point> scale_points(const std::vector<Region>& regions,
                                                           const CameraModel& camera, const TrackFrame& keyframe);

// Unit vector of the axis along which a region moves (Region::axis_deg).
[[nodiscard]] Vector2 axis_of(const Region& region) noexcept;

}  // namespace core
