#pragma once

#include <optional>
#include <string>

#include "core/types/frame.h"

namespace app {

// The first frame in a run record, for the report's pictures: a gray JPEG. Empty if there is no image.
[[nodiscard]] std::string keyframe_jpeg(const core::Frame& image);

// Empty if the bytes are not a JPEG of the camera's size.
[[nodiscard]] std::optional<core::Frame> keyframe_of(const std::string& jpeg, const core::CameraInfo& camera);

}  // namespace app
