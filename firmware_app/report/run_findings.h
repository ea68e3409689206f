#pragma once

#include <string>
#include <vector>

#include "core/geometry/motion_axes.h"
#include "core/types/frame.h"
#include "firmware_app/config/config.h"
#include "firmware_app/report/pictures/pictures.h"

namespace app {

// Configuration data for the pictures of a run: for the service and the offline replay.
[[nodiscard]] PictureInputs picture_inputs(const AppConfig& config, const core::CameraInfo& camera,
                                           const std::vector<core::ChannelInfo>& channels);
// Reads the result with which the page compares the modes; an empty path is none. A file that cannot be read
// is stated on the page: a record may be replayed where the file is not.
void compare_with(PictureInputs& inputs, const std::string& path);
// `source`: an address, or a path, of which only the last component is reported.
[[nodiscard]] RunFacts run_facts(const AppConfig& config, const core::CameraInfo& camera, const std::string& source,
                                 const core::Health& health, const core::ModalEstimate& estimate,
                                 const core::MotionAxes& axes);

}  // namespace app
