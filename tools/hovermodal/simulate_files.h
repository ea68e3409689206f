#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/simulation/scene_motion.h"
#include "core/simulation/track_generator.h"

namespace tools {

// What `hovermodal simulate` makes, apart from where.
struct SimulateJob {
  core::simulation::Scene scene;
  bool tracks_only = false;
  int crf = 20;

  [[nodiscard]] const char* product() const noexcept { return tracks_only ? "tracks.csv" : "clip.mp4"; }
};

// One line that is equal exactly when two jobs give the same product.
[[nodiscard]] std::string parameter_line(const SimulateJob& job);
// The folder holds the finished product of this very job.
[[nodiscard]] bool already_made(const std::filesystem::path& folder, const SimulateJob& job);

// Each writes its file whole or throws std::runtime_error (drivers::FileError).
void write_truth(const std::filesystem::path& folder, const SimulateJob& job,
                 const core::simulation::SceneMotion& motion);
void write_true_displacements(const std::filesystem::path& folder, const core::simulation::SceneMotion& motion);
void write_tracks(const std::filesystem::path& folder, const SimulateJob& job);
void write_config(const std::filesystem::path& folder, const SimulateJob& job,
                  const core::simulation::SceneMotion& motion, const std::string& method);

}  // namespace tools
