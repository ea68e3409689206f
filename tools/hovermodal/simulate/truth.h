#pragma once

#include <filesystem>
#include <string>

#include "core/simulation/scene_motion.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// One line that is equal exactly if two jobs give the same product.
[[nodiscard]] std::string parameter_line(const SimulateJob& job);
// Whether the folder contains the complete product of this job.
[[nodiscard]] bool already_made(const std::filesystem::path& folder, const SimulateJob& job);

// truth.json: all parameters of the simulated record, and the size of each effect. Throws std::runtime_error.
void write_truth(const std::filesystem::path& folder, const SimulateJob& job,
                 const core::simulation::SceneMotion& motion);

}  // namespace tools
