#pragma once

#include <memory>
#include <string>

#include "drivers/camera/camera_factory.h"
#include "drivers/camera/recording/frame_source.h"
#include "drivers/host/command_line.h"

namespace tools {

// --decoder-mb: as camera.decoder_mb, for commands that read a clip without a configuration.
void add_decoder_option(drivers::Command& command, int& decoder_mb);

// As drivers::make_camera and drivers::open_frame_source, but what they throw names options instead of keys.
[[nodiscard]] std::unique_ptr<drivers::Camera> open_clip_camera(const drivers::CameraOptions& options);
[[nodiscard]] std::unique_ptr<drivers::FrameSource> open_clip(const std::string& path, int decoder_mb);

}  // namespace tools
