#pragma once

#include <string>
#include <vector>

#include "core/closure/observation/observation_record.h"
#include "core/geometry/camera_model.h"
#include "core/types/frame.h"
#include "firmware_app/config.h"

namespace app {

// What closing the loop on tracks is told of a run: all but its points and frames.
struct DeclaredObservation {
  core::closure::ObservationRecord record;
  core::CameraModel camera;
  std::vector<std::string> warnings;  // what was assumed
};

// The configuration's word goes before the camera's. Throws drivers::FileError of a calibration file.
[[nodiscard]] DeclaredObservation declared_observation(const AppConfig& config, const core::CameraInfo& camera);

}  // namespace app
