#pragma once

#include <filesystem>

#include "core/simulation/scene_motion.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// config.yaml for the service: what the operator declares of the camera, and what a user would mark in the first frame.
// Throws std::runtime_error (drivers::FileError).
void write_config(const std::filesystem::path& folder, const SimulateJob& job,
                  const core::simulation::SceneMotion& motion);

}  // namespace tools
