#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/plane_pose.h"
#include "firmware_app/config/config.h"

namespace app {

// Scale in the first image (mm per px), evaluated from the configuration.
struct StructureScale {
  double mm_per_px = 1.0;                // common scale, of undistorted px; 1 where no length is known
  double sigma = 0.0;                    // its standard deviation; 0 = unknown
  bool known = false;                    // false: displacements are in px
  std::optional<core::PlanePose> plane;  // with scale.points
  std::vector<double> region_mm_per_px;  // per region, along its axis (both: along u) at its centre: its own length, or
                                         // the plane's local scale, or the common one
  std::vector<std::string> notes;        // for the report: obliqueness found or not excluded, lengths that disagree
};

// Throws ConfigError when scale.points determine no plane, contradict each other, or a region lies outside the plane.
[[nodiscard]] StructureScale structure_scale(const AppConfig& config, const core::CameraModel& camera);

}  // namespace app
