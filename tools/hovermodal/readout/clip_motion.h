#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/gyro_readout.h"
#include "core/types/frame.h"
#include "drivers/camera/camera_kind.h"

namespace tools {

struct ClipFile {
  std::string path;
  int decoder_mb = drivers::kDecoderMb;
};

struct ClipMotion {
  int width_px = 0, height_px = 0;
  std::size_t n_frames = 0;
  std::vector<core::FramePair> pairs;
};

// Corners spread over each frame, tracked into the next one and back. Pairs with too few points are left out. Every
// `hold_out_every`-th pair is held out. stamps_s: of the clip's frames, in order. ignored: left, top, width, height of
// the picture that move with the camera. is_quiet: no progress on standard error.
// Throws as drivers::open_frame_source does; std::invalid_argument: fewer stamps than frames.
[[nodiscard]] ClipMotion track_clip(const ClipFile& file, const std::vector<double>& stamps_s,
                                    const core::CameraModel& camera, core::ReadoutDirection direction,
                                    int hold_out_every, const std::vector<std::array<double, 4>>& ignored,
                                    bool is_quiet);

}  // namespace tools
