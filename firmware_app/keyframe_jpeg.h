#pragma once

#include <optional>
#include <string>

#include "core/types/frame.h"

namespace app {

// The first frame as a record keeps it, for the report's pictures: a gray JPEG. Empty where there is no image.
[[nodiscard]] std::string keyframe_jpeg(const core::Frame& image);

// Nothing where the bytes are no JPEG of the camera's size.
[[nodiscard]] std::optional<core::Frame> keyframe_of(const std::string& jpeg, const core::CameraInfo& camera);

}  // namespace app
