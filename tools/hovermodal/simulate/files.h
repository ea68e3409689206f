#pragma once

#include <filesystem>

#include "core/simulation/scene_motion.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// Each function writes its file completely or throws std::runtime_error (drivers::FileError).

// truth_displacements.csv: true absolute motion of the bodies at the times of exposure.
void write_true_displacements(const std::filesystem::path& folder, const core::simulation::SceneMotion& motion);
// tracks.csv and displacements.csv in the format of a run of the service. Progress goes to standard error,
// unless `is_quiet`.
void write_tracks(const std::filesystem::path& folder, const SimulateJob& job, bool is_quiet = false);
void write_channels(const std::filesystem::path& folder, const SimulateJob& job,
                    const core::simulation::SceneMotion& motion, bool is_quiet = false);

}  // namespace tools
