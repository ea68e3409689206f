#pragma once

#include <memory>
#include <string>

#include "drivers/camera/recording/frame_source.h"

namespace drivers {

// Any video that libavformat and libavcodec open (container.h). Throws std::runtime_error unless its first frame
// decodes and is usable. Rotation metadata is applied (frames are delivered as a player shows them) and reported in
// SourceInfo::turned_clockwise_deg. A frame that did not decode completely is left out and counted.
[[nodiscard]] std::unique_ptr<FrameSource> open_video(const std::string& path, int decoder_mb);

}  // namespace drivers
