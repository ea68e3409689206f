#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/geometry/camera_model.h"
#include "core/types/frame.h"
#include "core/types/track.h"
#include "firmware_app/config.h"

namespace app {

// What closing the loop on tracks is told of a run: all but its points and frames.
struct DeclaredObservation {
  core::closure::ObservationRecord record;
  core::CameraModel camera;
  std::vector<std::string> warnings;  // what was assumed
};

// Which of a run's points are looked at: so many of each region, evenly over its points.
struct ObservedPoints {
  std::vector<int> column_of_point;  // -1: not looked at
  std::vector<std::size_t> region_of_column;
};
[[nodiscard]] ObservedPoints observed_points(const core::TrackFrame& keyframe, std::size_t n_regions,
                                             int points_per_region);

// The configuration's word goes before the camera's. Throws drivers::FileError of a calibration file.
[[nodiscard]] DeclaredObservation declared_observation(const AppConfig& config, const core::CameraInfo& camera);

}  // namespace app
