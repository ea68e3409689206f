#pragma once

#include <filesystem>
#include <string>

#include "core/simulation/scene_motion.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// One line that is equal exactly when two jobs give the same product.
[[nodiscard]] std::string parameter_line(const SimulateJob& job);
// The folder holds the finished product of this very job.
[[nodiscard]] bool already_made(const std::filesystem::path& folder, const SimulateJob& job);

// truth.json: everything that was put into the record, and how large each effect is. Throws std::runtime_error.
void write_truth(const std::filesystem::path& folder, const SimulateJob& job,
                 const core::simulation::SceneMotion& motion);

}  // namespace tools
