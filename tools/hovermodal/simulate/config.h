#pragma once

#include <filesystem>
#include <string>

#include "core/simulation/scene_motion.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// The text of config.yaml for the service: the operator's declarations of the camera, and the regions a user would mark
// in the first frame. `source`: the file used as camera.
[[nodiscard]] std::string config_text(const SimulateJob& job, const core::simulation::SceneMotion& motion,
                                      const std::string& source);

// Throws std::runtime_error (drivers::FileError).
void write_config(const std::filesystem::path& folder, const SimulateJob& job,
                  const core::simulation::SceneMotion& motion);

}  // namespace tools
