#pragma once

#include <optional>
#include <string>

#include "core/simulation/render/renderer.h"

namespace tools {

// Renders every frame that the scene's timing delivers on `n_threads` threads and writes them in order: as H.264 of
// quality `crf` (drivers/storage/clip_writer.h), without it uncompressed (raw_clip.h). If the scene's stamps show
// jitter or drops, they are written beside the clip (drivers/camera/recording/timestamp_file.h); an older such file is
// removed in any case. Progress goes to standard error, unless `is_quiet`. Throws std::runtime_error when the encoder
// or the disk fails; the clip then does not exist.
void write_clip(const core::simulation::Renderer& renderer, const std::string& path, std::optional<int> crf,
                int n_threads, bool is_quiet = false);

// The file of those stamps, and whether this scene's clip needs it.
[[nodiscard]] std::string stamps_path(const std::string& clip_path);
[[nodiscard]] bool needs_stamps(const core::simulation::Scene& scene) noexcept;

}  // namespace tools
