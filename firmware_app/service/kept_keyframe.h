#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "core/types/frame.h"
#include "core/types/track.h"

namespace app {

// The keyframe (reference of all displacements), kept beside the run's checkpoint: constant over a run, written once,
// in the format of a checkpoint file (drivers/storage/checkpoint_file.h): read as a whole or refused.
struct KeptKeyframe {
  core::Frame image;
  core::TrackFrame points;
};

struct KeyframeRead {
  std::optional<KeptKeyframe> keyframe;
  std::string refused;  // why the file is not used; empty: it is, or there is none
};

// Empty: written; otherwise the reason why not.
[[nodiscard]] std::string write_keyframe(const std::string& path, std::uint64_t config_hash, const core::Frame& image,
                                         const core::TrackFrame& points);
// Refused: damaged, of another configuration or image size, or inconsistent.
[[nodiscard]] KeyframeRead read_keyframe(const std::string& path, std::uint64_t config_hash,
                                         const core::CameraInfo& camera, std::size_t n_regions);

}  // namespace app
