#pragma once

#include <memory>
#include <string>

#include "drivers/camera/recording/frame_source.h"

namespace drivers {

// Any video that OpenCV's FFmpeg backend opens. Throws std::runtime_error unless its first frame decodes and is usable.
// Rotation metadata is obeyed (frames are delivered as a player shows them) and reported in
// SourceInfo::turned_clockwise_deg.
[[nodiscard]] std::unique_ptr<FrameSource> open_video(const std::string& path);

}  // namespace drivers
