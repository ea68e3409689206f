#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/geometry/gyro_readout.h"
#include "core/types/frame.h"
#include "drivers/camera/camera_kind.h"
#include "drivers/host/command_line.h"
#include "tools/hovermodal/readout/clip_motion.h"

namespace tools {

// A clip, its frames' stamps and the record of a gyro mounted on the camera, as named on the command line.
struct GyroClipOptions {
  std::string clip, stamps, gyro, calibration;
  int decoder_mb = drivers::kDecoderMb;
  std::vector<std::array<double, 4>> ignored;
  double time_unit_s = 1.0, focal_px = 0.0, most_offset_s = 0.1;
  int first_stamp = 0, hold_out_every = 4;
  core::ReadoutDirection direction = core::ReadoutDirection::kDown;
};
void add_gyro_clip_options(drivers::Command& command, GyroClipOptions& options, bool required);

struct GyroClip {
  ClipMotion motion;
  std::vector<core::GyroSample> gyro;
  core::GyroReadoutConfig config;
};
// Throws drivers::FileError, std::invalid_argument, and as track_clip() does.
// is_quiet: no progress on standard error.
[[nodiscard]] GyroClip read_gyro_clip(const GyroClipOptions& options, bool is_quiet);

}  // namespace tools
