#pragma once

#include <filesystem>

#include "core/simulation/scene_motion.h"
#include "tools/hovermodal/simulate/job.h"

namespace tools {

// Each writes its file whole or throws std::runtime_error (drivers::FileError).

// truth_displacements.csv: the bodies' true absolute motion at the times at which pictures were taken.
void write_true_displacements(const std::filesystem::path& folder, const core::simulation::SceneMotion& motion);
// tracks.csv and displacements.csv as a run of the service leaves them.
void write_tracks(const std::filesystem::path& folder, const SimulateJob& job);
void write_channels(const std::filesystem::path& folder, const SimulateJob& job,
                    const core::simulation::SceneMotion& motion);

}  // namespace tools
