#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/geometry/camera_model.h"
#include "core/rotors/motor_lines.h"
#include "core/types/closure_result.h"
#include "core/types/frame.h"
#include "core/types/track.h"
#include "firmware_app/config/config.h"

namespace app {

// Declarations of a run for residual diagnosis on tracks: everything except points and frames.
struct DeclaredObservation {
  core::closure::ObservationRecord record;
  core::CameraModel camera;
  std::vector<std::string> warnings;  // assumptions made
};

// Points of a run that are analysed: an equal number per region, spread evenly over its points.
struct ObservedPoints {
  std::vector<int> column_of_point;  // -1: not analysed
  std::vector<std::size_t> region_of_column;
};
[[nodiscard]] ObservedPoints observed_points(const core::TrackFrame& keyframe, std::size_t n_regions,
                                             int points_per_region);

// The configuration takes precedence over the camera. Throws drivers::FileError if a calibration file is refused.
[[nodiscard]] DeclaredObservation declared_observation(const AppConfig& config, const core::CameraInfo& camera);

// Adds the motors to the rotor lines that were found in this record: those stated during the run, else those of
// camera.motors_file. Throws drivers::FileError.
void name_motors(const AppConfig& config, const core::MotorLines& stated,
                 const core::closure::ObservationRecord& record, core::closure::ClosureResult& result);

}  // namespace app
