#pragma once

#include "core/geometry/camera_model.h"
#include "core/types/frame.h"
#include "firmware_app/config/config.h"

namespace app {

// The camera of `config`, from calibration.file or from inline values; not calibrated if there is neither. Throws
// ConfigError / FileError if it does not fit the image of `camera` (drivers::calibration_fault), or was made for
// another resolution; where the aspect ratio is equal, the error then contains the scaled values.
[[nodiscard]] core::CameraModel camera_model(const AppConfig& config, const core::CameraInfo& camera);

}  // namespace app
