#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/types/frame.h"
#include "drivers/storage/scene/scene_file.h"

namespace tools {

// What is simulated: displacements, tracks of points, or a clip.
enum class Depth : std::uint8_t { kChannels, kTracks, kPixels };

// Options of the command line. Missing ones come from the scene file, or from the preset.
struct SimulateOptions {
  std::string scene_path, folder, method = "hovermodal";
  std::optional<std::string> preset, size;
  std::optional<std::uint64_t> seed;
  std::optional<double> duration_s, track_noise_px, track_loss;
  std::optional<int> points;
  bool tracks_only = false, channels_only = false, force = false, print_scene = false, help_scene = false;
  bool raw = false;
  int crf = 20, threads = 0;
};

// What `hovermodal simulate` generates, without the folder.
struct SimulateJob {
  drivers::SceneFile file;
  Depth depth = Depth::kPixels;
  std::optional<int> crf = 20;        // of a clip; without it: uncompressed
  std::string method = "hovermodal";  // in config.yaml

  [[nodiscard]] const core::simulation::Scene& scene() const noexcept { return file.scene; }
  [[nodiscard]] const char* product() const noexcept;
  // The camera as declared by the operator, used for headers of files and row delays.
  [[nodiscard]] core::CameraInfo declared_camera() const;
  [[nodiscard]] bool declares_lens() const noexcept;
};

// Throws std::invalid_argument.
[[nodiscard]] SimulateJob make_job(const SimulateOptions& options);

}  // namespace tools
