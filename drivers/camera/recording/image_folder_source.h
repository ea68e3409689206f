#pragma once

#include <memory>
#include <string>

#include "drivers/camera/recording/frame_source.h"

namespace drivers {

// By the extension of the file name.
[[nodiscard]] bool is_image_file(const std::string& path);

// Natural order of file names: runs of digits by value, so that frame_10 follows frame_9.
[[nodiscard]] bool natural_less(const std::string& a, const std::string& b) noexcept;

// The images of a folder, sorted by natural_less, as they are stored (an EXIF rotation is not applied). Throws
// std::runtime_error when there is none, or when the first or the last one is unusable: 16 bit, float, with alpha,
// too small, of different sizes. The others are checked when they are read.
[[nodiscard]] std::unique_ptr<FrameSource> open_image_folder(const std::string& path);

}  // namespace drivers
